// What React Flow is told of the boxes of a tree and of the lines between them.
import { type Edge, type NodeHandle, Position } from "@xyflow/react";
import { HEIGHT, type Placed, WIDTH } from "./layout";

const HANDLES: NodeHandle[] = [
  { type: "target", position: Position.Top, x: WIDTH / 2, y: 0, width: 1, height: 1 },
  { type: "source", position: Position.Bottom, x: WIDTH / 2, y: HEIGHT, width: 1, height: 1 },
];

// Told and not measured, since nodes outside of the picture are not drawn: lines go to them, and the overview has them.
export const BOX = { width: WIDTH, height: HEIGHT, measured: { width: WIDTH, height: HEIGHT }, handles: HANDLES };

/** A line to each box from its parent's. */
export const linesTo = (places: Placed<{ path: string }>[]): Edge[] =>
  places
    .filter(({ node }) => node.path.includes("."))
    .map(({ node }) => ({
      id: node.path,
      source: node.path.slice(0, node.path.lastIndexOf(".")),
      target: node.path,
      type: "smoothstep",
      focusable: false,
    }));
