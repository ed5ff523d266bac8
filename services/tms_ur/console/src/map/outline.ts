// Bodies of a machine seen from above.

import { type Frame, type Point, put } from "./pose";
import type { Prism } from "./shapes";

export type Flat = readonly [number, number]; // x, y in map, m

/** The corners of a prism in the frame in which its link is told. */
export function corners(prism: Prism, frame: Frame): Point[] {
  return prism.outline.flatMap(([x, z]) => [put(frame, [x, prism.y0, z]), put(frame, [x, prism.y1, z])]);
}

/** The convex hull of points, anticlockwise (A. M. Andrew, 1979). */
export function hull(points: readonly Flat[]): Flat[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const lower = chain(sorted);
  const upper = chain(sorted.reverse());
  return [...lower.slice(0, -1), ...upper.slice(0, -1)];
}

function chain(points: readonly Flat[]): Flat[] {
  const found: Flat[] = [];
  for (const point of points) {
    while (found.length > 1 && !left(found[found.length - 2], found[found.length - 1], point)) {
      found.pop();
    }
    found.push(point);
  }
  return found;
}

function left(a: Flat | undefined, b: Flat | undefined, c: Flat): boolean {
  return a !== undefined && b !== undefined && (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
}

/** What a prism covers on the map. */
export const shadow = (prism: Prism, frame: Frame) => hull(corners(prism, frame).map(([x, y]) => [x, y]));

/** SVG has y downwards. */
export const svgPoints = (points: readonly (readonly number[])[]) =>
  points.map(([x = 0, y = 0]) => `${x.toFixed(2)},${(-y).toFixed(2)}`).join(" ");
