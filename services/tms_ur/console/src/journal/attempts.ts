// How often a node was tried, how long each took, and what came of it.
import type { NodeState } from "../tree/shape";
import type { Journal } from "./journal";

export interface Attempt {
  index: number; // of the node
  begin: number; // ms since the epoch
  end: number | null; // null: it goes on
  state: NodeState; // "idle": it was halted
  event: number; // index of the event that ended it, or began it
}

/** All attempts among the first `count` events, in the order of their begins. A node that ends at once has one of 0 ms. */
export function attemptsOf(journal: Journal, count: number): Attempt[] {
  const found: Attempt[] = [];
  const open = new Map<number, Attempt>();
  for (const { event, index, before, state } of journal.changes) {
    if (event >= count) {
      break;
    }
    const now = journal.times[event] ?? 0;
    const running = open.get(index);
    if (running !== undefined && state !== "running") {
      Object.assign(running, { end: now, state, event });
      open.delete(index);
    } else if (state === "running") {
      const begun: Attempt = { index, begin: now, end: null, state, event };
      open.set(index, begun);
      found.push(begun);
    } else if (state !== "idle" && before !== state) {
      found.push({ index, begin: now, end: now, state, event });
    }
  }
  return found;
}
