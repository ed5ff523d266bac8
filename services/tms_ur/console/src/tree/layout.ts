// Where nodes stand: top down, as Groot draws them.
import { hierarchy, tree } from "d3-hierarchy";
import type { TreeNode } from "./shape";

export const WIDTH = 200; // px
export const HEIGHT = 64; // px
const GAP_X = 16;
const GAP_Y = 40;

export interface Placed {
  node: TreeNode;
  x: number; // px, of its left upper corner
  y: number;
}

/** The nodes that are shown, from the root; `open` holds paths of those whose children are. */
export function placed(root: TreeNode, open: Set<string>): Placed[] {
  const shown = hierarchy(root, (node) => (open.has(node.path) ? node.children : []));
  const arranged = tree<TreeNode>()
    .nodeSize([WIDTH + GAP_X, HEIGHT + GAP_Y])
    .separation(() => 1)(shown);
  return arranged.descendants().map(({ data, x, y }) => ({ node: data, x: x - WIDTH / 2, y }));
}
