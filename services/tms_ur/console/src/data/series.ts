// The history of a record as lines: its numbers by time.
import type { RecordChange } from "../models";
import type { Line } from "../plot";

/** From changes, newest first; a change that leaves a field as it is has no value of it. */
export function linesOf(changes: RecordChange[]): { times: number[]; lines: Line[] } {
  const dated = changes.filter((change) => change.stamp).reverse();
  const names = [...new Set(dated.flatMap((change) => Object.keys(change.values)))];
  const number = (value: unknown) => (typeof value === "number" ? value : null);
  return {
    times: dated.map((change) => Date.parse(change.stamp ?? "") / 1000),
    lines: names
      .map((name) => ({ name, values: dated.map((change) => number(change.values[name])) }))
      .filter((line) => line.values.some((value) => value !== null)),
  };
}
