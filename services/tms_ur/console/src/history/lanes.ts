// What each machine did when: a lane a machine, with a bar for each try of a leaf that names it.
import { type Attempt, attemptsOf } from "../journal/attempts";
import type { Journal } from "../journal/journal";
import { nodesOf } from "../tree/shape";

export interface Bar extends Attempt {
  label: string; // the goal of the leaf
}

export interface Lane {
  machine: string;
  bars: Bar[];
}

export function lanesOf(journal: Journal): Lane[] {
  if (journal.tree === null) {
    return [];
  }
  const nodes = [...nodesOf(journal.tree).values()];
  const lanes = new Map<string, Bar[]>();
  for (const attempt of attemptsOf(journal, journal.events.length)) {
    const node = nodes[attempt.index];
    if (node !== undefined && node.machine !== "" && node.children.length === 0) {
      lanes.set(node.machine, [...(lanes.get(node.machine) ?? []), { ...attempt, label: node.label }]);
    }
  }
  return [...lanes].map(([machine, bars]) => ({ machine, bars }));
}

/** Times of the stops, ms. */
export const stopsOf = ({ events, times }: Journal): number[] =>
  times.filter((_, index) => events[index]?.kind === "stop");
