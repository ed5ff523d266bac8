// The values of a record at a past moment, from its changes.
import type { RecordChange } from "../models";

/** The last value of each field that was written until then, and when that was; null: none that is kept. */
export function valuesThen(changes: RecordChange[], time: number) {
  const told = changes.filter(({ stamp }) => stamp && Date.parse(stamp) <= time);
  const [newest] = told; // they come newest first
  return newest === undefined
    ? null
    : { values: Object.assign({}, ...told.toReversed().map((one) => one.values)) as RecordChange["values"], newest };
}
