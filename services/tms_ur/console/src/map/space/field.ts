// Heights of the ground, cut into tiles that are drawn the coarser the farther they are. Pure: no drawing here.

import type { Ground } from "../../models";
import type { Flat } from "../outline";

/** Quads along the side of a tile. */
export const SIDE = 32;
export const COARSEST = 16; // quads that become one at most
const NEAR = 40; // m within which a tile has all its quads, where the budget allows it
const FARTHER = 0.8; // by which the near range shrinks until the budget is kept

export interface Tile {
  column: number; // of its first vertex
  row: number;
  middle: Flat; // m, map
}

/** The heights of one surface: of the ground, or of its design. */
export class Field {
  constructor(
    readonly ground: Ground,
    private readonly heights: readonly (number | null)[],
  ) {}

  /** m; undefined where it is not known. Vertices are at the middles of cells. */
  at(column: number, row: number): number | undefined {
    const { columns, rows } = this.ground;
    const inside = column >= 0 && row >= 0 && column < columns && row < rows;
    return inside ? (this.heights[row * columns + column] ?? undefined) : undefined;
  }

  x = (column: number) => this.ground.x0 + (column + 0.5) * this.ground.cell;
  y = (row: number) => this.ground.y0 + (row + 0.5) * this.ground.cell;

  /** The height [m] at a place in map: that of the nearest cell, 0 where it is not known. */
  near(x: number, y: number): number {
    const { x0, y0, cell } = this.ground;
    return this.at(Math.floor((x - x0) / cell), Math.floor((y - y0) / cell)) ?? 0;
  }

  /** Rise along x and y. */
  slope(column: number, row: number): Flat {
    const here = this.at(column, row) ?? 0;
    const rise = (dx: number, dy: number) => {
      const [after, before] = [this.at(column + dx, row + dy) ?? here, this.at(column - dx, row - dy) ?? here];
      return (after - before) / (2 * this.ground.cell);
    };
    return [rise(1, 0), rise(0, 1)];
  }

  tiles(): Tile[] {
    const found: Tile[] = [];
    for (let row = 0; row < this.ground.rows - 1; row += SIDE) {
      for (let column = 0; column < this.ground.columns - 1; column += SIDE) {
        found.push({ column, row, middle: [this.x(column + SIDE / 2), this.y(row + SIDE / 2)] });
      }
    }
    return found;
  }
}

/** Triangles of a tile whose quads are `stride` cells wide, with a skirt that hides gaps to its neighbours. */
export const trianglesOf = (stride: number) => 2 * (SIDE / stride) ** 2 + 8 * (SIDE / stride);

/** How coarse each tile is, seen from a place: all together have at most `most` triangles. */
export function strides(tiles: readonly Tile[], [x, y]: Flat, height: number, most: number): number[] {
  const away = tiles.map(({ middle }) => Math.hypot(middle[0] - x, middle[1] - y, height));
  for (let near = NEAR; ; near *= FARTHER) {
    const found = away.map((distance) => strideAt(distance, near));
    const sum = found.reduce((total, stride) => total + trianglesOf(stride), 0);
    if (sum <= most || found.every((stride) => stride === COARSEST)) {
      return found;
    }
  }
}

function strideAt(distance: number, near: number): number {
  const wanted = 2 ** Math.max(0, Math.ceil(Math.log2(distance / near)));
  return Math.min(COARSEST, wanted);
}
