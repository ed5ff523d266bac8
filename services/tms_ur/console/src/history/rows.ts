// The rows of a journal's table: the newest first, filtered, and repeated ones folded.
import type { Event } from "../models";

export const MOST = 100; // rows
const FAR = 5000; // events that are looked through for them

export interface Row {
  event: Event; // the newest of its kind
  times: number; // how often it is there
}

export interface Wanted {
  kind: string; // empty: all
  words: string; // that its text or node holds
  fold: boolean; // polling repeats the same changes for hours
}

/** Of the first `count` events; `textOf` gives what people read. */
export function rowsOf(events: Event[], count: number, wanted: Wanted, textOf: (event: Event) => string): Row[] {
  const rows = new Map<string, Row>();
  const words = wanted.words.toLowerCase();
  for (let index = count - 1; index >= Math.max(0, count - FAR); index -= 1) {
    const event = events[index];
    if (event === undefined || event.kind === "tree" || (wanted.kind !== "" && event.kind !== wanted.kind)) {
      continue;
    }
    const text = textOf(event);
    if (!`${event.node} ${text}`.toLowerCase().includes(words)) {
      continue;
    }
    const key = wanted.fold ? `${event.kind} ${event.node} ${text}` : String(event.number);
    const there = rows.get(key);
    if (there !== undefined) {
      there.times += 1;
    } else if (rows.size < MOST) {
      rows.set(key, { event, times: 1 });
    } else {
      break;
    }
  }
  return [...rows.values()];
}

/** All kinds of events in a journal, by name. */
export const kindsOf = (events: Event[]) =>
  [...new Set(events.map((event) => event.kind))].filter((kind) => kind !== "tree").sort();
