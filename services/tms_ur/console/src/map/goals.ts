// Places that records hold, and which of them machines go to now.

import { treeOf } from "old/server.js";
import type { ActiveRun, Stored } from "../models";
import type { Flat } from "./outline";

/** One pose, or a path, of a record. */
export interface PlaceRecord {
  model: string; // machine; empty: of all
  record: string;
  points: Flat[];
  goal: boolean; // a leaf that works now has it
}

const list = (value: unknown): unknown[] => (Array.isArray(value) ? value : [value]);

/** Records with x and y, each a number or a list. */
export function placesOf(records: readonly Stored[], runs: readonly ActiveRun[]): PlaceRecord[] {
  const wanted = new Set(runs.map(currentRecord));
  return records.flatMap(({ model_name: model, record_name: record, values }) => {
    const ys = list(values.y);
    const points = list(values.x).flatMap((x, index) => {
      const y = ys[index];
      return typeof x === "number" && typeof y === "number" ? [[x, y] as const] : [];
    });
    return points.length > 0 ? [{ model, record, points, goal: wanted.has(record) }] : [];
  });
}

/** The record of the running leaf, from its port. */
function currentRecord(run: ActiveRun): string | undefined {
  const tree = treeOf(run.run_id);
  const index = tree?.paths.indexOf(run.leaf) ?? -1;
  return /record_name="([^"]*)"/.exec(tree?.ports[index] ?? "")?.[1];
}
