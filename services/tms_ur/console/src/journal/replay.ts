// The tree as it was after some of the events of its journal.
import { type NodeState, STATES } from "../tree/shape";
import type { Journal } from "./journal";

export interface Moment {
  digits: string; // state of every node
  last: Map<number, NodeState>; // of each node by its index: the last state that was not idle
  leaf: string; // path of the node that changed last
}

/** After the first `count` events. */
export function momentAfter({ tree, changes }: Journal, count: number): Moment {
  const digits = (tree?.paths ?? []).map(() => 0);
  const last = new Map<number, NodeState>();
  let leaf = "";
  for (const { event, index, path, before, state } of changes) {
    if (event >= count) {
      break;
    }
    digits[index] = STATES.indexOf(state);
    last.set(index, state === "idle" ? before : state);
    leaf = path;
  }
  return { digits: digits.join(""), last, leaf };
}
