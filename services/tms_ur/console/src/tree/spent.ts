// How long the nodes of a run worked, all their tries together.
import { attemptsOf } from "../journal/attempts";
import type { Journal } from "../journal/journal";

export interface Spent {
  seconds: number;
  heat: number; // 0 to HOTTEST, against the longest of its kind: of leaves, or of nodes with children
}

const HOTTEST = 4;

/** By the index of the node, among the first `count` events; those that were never tried are not in it. */
export function spentIn(journal: Journal, count: number, now: number): Map<number, Spent> {
  const seconds = new Map<number, number>();
  for (const { index, begin, end } of attemptsOf(journal, count)) {
    seconds.set(index, (seconds.get(index) ?? 0) + Math.max(0, (end ?? now) - begin) / 1000);
  }
  const inner = new Set(journal.tree?.paths.map((path) => path.slice(0, path.lastIndexOf("."))));
  const isInner = (index: number) => inner.has(journal.tree?.paths[index] ?? "");
  const longest = (kind: boolean) =>
    [...seconds].reduce((most, [index, one]) => (isInner(index) === kind ? Math.max(most, one) : most), 0);
  const most = new Map([true, false].map((kind) => [kind, longest(kind)]));
  return new Map(
    [...seconds].map(([index, one]) => {
      const part = one / (most.get(isInner(index)) || 1);
      return [index, { seconds: one, heat: Math.round(part * HOTTEST) }];
    }),
  );
}
