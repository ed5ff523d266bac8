// The journal of a run: its events by time, and the changes of its nodes.
import type { Event, Tree } from "../models";
import { type NodeState, STATES } from "../tree/shape";

/** A node took another state. */
export interface Change {
  event: number; // index of its event
  index: number; // of the node, in the lists of the tree
  path: string;
  before: NodeState;
  state: NodeState;
}

export interface Journal {
  events: Event[];
  times: number[]; // ms since the epoch, of each event; never falling, also where the clock of the PC was set back
  tree: Tree | null; // null: a run that was refused has none
  changes: Change[];
  cut: boolean; // there are more events than a browser replays
}

const stateNamed = (name: unknown) => STATES.find((state) => state.toUpperCase() === name);

/** The old and the new state of a node; journals of releases without reasons have both in their text. */
function statesOf(event: Event): [NodeState, NodeState] | null {
  const words = / (?<old>[A-Z]+) -> (?<new>[A-Z]+)/.exec(` ${event.text}`)?.groups;
  const [before, state] = [event.reason?.args, words].flatMap((one) => {
    const found = [stateNamed(one?.old), stateNamed(one?.new)];
    return found.every((state) => state !== undefined) ? found : [];
  });
  return before === undefined || state === undefined ? null : [before, state];
}

function treeOf(events: Event[]): Tree | null {
  const values = events.find((event) => event.kind === "tree")?.values;
  return values === undefined ? null : ({ templates: [], ...values } as unknown as Tree); // older ones have no templates
}

function changesOf(events: Event[], tree: Tree | null): Change[] {
  const numbers = new Map(tree?.paths.map((path, index) => [path, index]));
  return events.flatMap((event, number) => {
    const index = event.kind === "node" ? numbers.get(event.node) : undefined;
    const states = index === undefined ? null : statesOf(event);
    return index === undefined || states === null
      ? []
      : [{ event: number, index, path: event.node, before: states[0], state: states[1] }];
  });
}

export function journalOf(events: Event[], cut: boolean): Journal {
  let latest = Number.NEGATIVE_INFINITY;
  const times = events.map((event) => {
    latest = Math.max(latest, event.stamp ? Date.parse(event.stamp) : latest);
    return latest;
  });
  const first = times.find(Number.isFinite) ?? 0;
  const tree = treeOf(events);
  const known = times.map((time) => (Number.isFinite(time) ? time : first));
  return { events, times: known, tree, changes: changesOf(events, tree), cut };
}

/** How many events there were up to a time, ms. */
export function countAt({ times }: Journal, time: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? 0) <= time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

export const beginOf = ({ times }: Journal) => times[0] ?? 0;
export const endOf = ({ times }: Journal) => times.at(-1) ?? 0;
