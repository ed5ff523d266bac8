// What React Flow is told of the boxes of a tree.
import { HEIGHT, WIDTH } from "./layout";

// Told and not measured, since nodes outside of the picture are not drawn, and the overview has them.
export const BOX = { width: WIDTH, height: HEIGHT, measured: { width: WIDTH, height: HEIGHT } };
