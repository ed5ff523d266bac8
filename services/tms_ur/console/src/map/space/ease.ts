// Machines move smoothly between two states, which come ten times a second.

import type { Machine } from "../../models";
import { anglesOf } from "../pose";

/** Where a machine is shown. */
export interface Shown {
  x: number; // m, map
  y: number;
  yaw: number; // rad
  angles: Map<string, number>; // rad
}

const TIME = 0.1; // s in which it comes nearer to what was told, to a third
const STILL = 1e-3; // m or rad that nobody sees
const FAR = 5; // m: it was moved, it did not drive

export function told(machine: Machine): Shown | null {
  const { place } = machine;
  return place ? { x: place.x, y: place.y, yaw: place.yaw, angles: anglesOf(machine) } : null;
}

/** Nearer to `to` after `seconds`, and whether it is still on its way. */
export function eased(from: Shown, to: Shown, seconds: number): { shown: Shown; moves: boolean } {
  if (Math.hypot(to.x - from.x, to.y - from.y) > FAR) {
    return { shown: to, moves: false };
  }
  const part = 1 - Math.exp(-seconds / TIME);
  let most = 0;
  const near = (a: number, b: number) => {
    most = Math.max(most, Math.abs(b - a));
    return a + (b - a) * part;
  };
  const round = (a: number, b: number) => near(a, a + Math.atan2(Math.sin(b - a), Math.cos(b - a)));
  const angles = new Map([...to.angles].map(([name, angle]) => [name, round(from.angles.get(name) ?? angle, angle)]));
  const shown = { x: near(from.x, to.x), y: near(from.y, to.y), yaw: round(from.yaw, to.yaw), angles };
  return most < STILL ? { shown: to, moves: false } : { shown, moves: true };
}
