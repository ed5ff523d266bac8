// Where machines have driven since this console was opened.

import type { Machine } from "../models";
import type { Flat } from "./outline";

const STEP = 0.2; // m between two points
const MOST = 2000; // points of a machine; older ones are forgotten

const trails = new Map<string, Flat[]>();

/** Adds where a machine is now. */
export function lengthened(trail: readonly Flat[], [x, y]: Flat): Flat[] {
  const last = trail[trail.length - 1];
  const near = last !== undefined && Math.hypot(x - last[0], y - last[1]) < STEP;
  return near ? [...trail] : [...trail.slice(1 - MOST), [x, y]];
}

/** The trails of these machines, up to now. */
export function trailsOf(machines: readonly Machine[]): ReadonlyMap<string, Flat[]> {
  for (const { name, place } of machines) {
    if (place) {
      trails.set(name, lengthened(trails.get(name) ?? [], [place.x, place.y]));
    }
  }
  return trails;
}
