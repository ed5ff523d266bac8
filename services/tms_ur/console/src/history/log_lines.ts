// Which log lines of a run are shown at a moment.
import type { Logs } from "../models";

export type LogLine = Logs["lines"][number];

export interface Row {
  key: number; // place among all lines
  time: number; // ms
  line: LogLine;
}

/** The last `most` lines up to `time`, in ms; lines come in the order of their times. */
export function linesUpTo(rows: Row[], time: number, most: number): Row[] {
  let [low, high] = [0, rows.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((rows[middle]?.time ?? 0) <= time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return rows.slice(Math.max(0, low - most), low);
}

export const rowsOf = (lines: LogLine[]): Row[] =>
  lines.map((line, key) => ({ key, time: Date.parse(line.time), line }));

/** How bad a line is, by its level. */
export const gravityOf = ({ level }: LogLine): "" | "warning" | "critical" =>
  level === "ERROR" || level === "CRITICAL" ? "critical" : level === "WARNING" ? "warning" : "";
