// Where nodes stand: top down, as Groot draws them.
import { hierarchy, tree } from "d3-hierarchy";

export const WIDTH = 200; // px
export const HEIGHT = 64; // px
const GAP_X = 16;
const GAP_Y = 40;

interface Branch<N> {
  path: string;
  children: N[];
}

export interface Placed<N> {
  node: N;
  x: number; // px, of its left upper corner
  y: number;
}

/** The nodes that are shown, from the root; `open` holds paths of those whose children are, null: all. */
export function placed<N extends Branch<N>>(root: N, open: Set<string> | null): Placed<N>[] {
  const shown = hierarchy(root, (node) => (open === null || open.has(node.path) ? node.children : []));
  const arranged = tree<N>()
    .nodeSize([WIDTH + GAP_X, HEIGHT + GAP_Y])
    .separation(() => 1)(shown);
  return arranged.descendants().map(({ data, x, y }) => ({ node: data, x: x - WIDTH / 2, y }));
}
