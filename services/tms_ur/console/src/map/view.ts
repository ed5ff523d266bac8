// The part of the map that is shown: it moves only when a person moves it, or follows a machine on request.

import type { Flat } from "./outline";

/** `x`, `y`: what is in the middle, m in map; `scale`: px a metre. */
export interface View {
  x: number;
  y: number;
  scale: number;
}

export interface Size {
  width: number; // px
  height: number; // px
}

const MARGIN = 6; // m around everything
const LEAST = 1; // px a metre: 1 km on a wall screen
const MOST = 200;

const clamped = (scale: number) => Math.min(MOST, Math.max(LEAST, scale));

/** Shows all points. */
export function fitted(points: readonly Flat[], { width, height }: Size): View {
  const xs = points.length > 0 ? points.map(([x]) => x) : [0];
  const ys = points.length > 0 ? points.map(([, y]) => y) : [0];
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const scale = Math.min(width / (x1 - x0 + 2 * MARGIN), height / (y1 - y0 + 2 * MARGIN));
  return { x: (x0 + x1) / 2, y: (y0 + y1) / 2, scale: clamped(scale) };
}

/** The place in map of a pixel of the picture. */
export function placeAt(view: View, { width, height }: Size, px: number, py: number): Flat {
  return [view.x + (px - width / 2) / view.scale, view.y - (py - height / 2) / view.scale];
}

/** Larger by `factor`; the place under the pixel stays there. */
export function zoomed(view: View, size: Size, factor: number, px: number, py: number): View {
  const [x, y] = placeAt(view, size, px, py);
  const scale = clamped(view.scale * factor);
  const rest = view.scale / scale;
  return { x: x + (view.x - x) * rest, y: y + (view.y - y) * rest, scale };
}

/** Moved by pixels, as a hand moves paper. */
export const dragged = (view: View, dx: number, dy: number): View => ({
  ...view,
  x: view.x - dx / view.scale,
  y: view.y + dy / view.scale,
});

export function viewBox(view: View, { width, height }: Size): string {
  const [w, h] = [width / view.scale, height / view.scale];
  return [view.x - w / 2, -view.y - h / 2, w, h].map((one) => one.toFixed(3)).join(" ");
}

/** Metres between lines of the grid, so that they are 30 px apart at least. */
export function gridStep(scale: number): number {
  return [1, 2, 5, 10, 20, 50, 100].find((step) => step * scale >= 30) ?? 200;
}
