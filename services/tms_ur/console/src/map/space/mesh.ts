// The triangles of a tile: plain numbers, which terrain.ts hands to the graphics.

import { type Field, SIDE, type Tile } from "./field";

export interface Mesh {
  positions: number[]; // x, y, z in turn, m
  colours: number[]; // red, green, blue in turn, 0 to 1
  triangles: number[];
}

type Colour = readonly [number, number, number];

const EARTH: Colour = [0.66, 0.55, 0.4];
const CUT: Colour = [0.85, 0.3, 0.2]; // soil that is to go
const FILL: Colour = [0.2, 0.45, 0.85]; // soil that is missing
const FULL = 1.0; // m between ground and design for the full colour
const SUN: Colour = [-0.45, -0.35, 0.82]; // from where
const SKIRT = 1.0; // m, below the edge

/** The surface of a tile; `design`: by which it is coloured, null for none. Quads with an unknown corner are left out. */
export function meshOf(field: Field, design: Field | null, tile: Tile, stride: number): Mesh {
  const mesh: Mesh = { positions: [], colours: [], triangles: [] };
  const columns = steps(tile.column, field.ground.columns, stride);
  const rows = steps(tile.row, field.ground.rows, stride);
  const numbers = rows.map((row) => columns.map((column) => vertex(mesh, field, design, column, row)));
  for (let j = 0; j + 1 < rows.length; j += 1) {
    for (let i = 0; i + 1 < columns.length; i += 1) {
      quad(mesh, numbers[j]?.[i], numbers[j]?.[i + 1], numbers[j + 1]?.[i + 1], numbers[j + 1]?.[i]);
    }
  }
  const last = numbers.length - 1;
  skirt(mesh, [...(numbers[0] ?? [])].reverse());
  skirt(mesh, numbers[last] ?? []);
  skirt(
    mesh,
    numbers.map((row) => row[0]),
  );
  skirt(mesh, numbers.map((row) => row[row.length - 1]).reverse());
  return mesh;
}

function steps(first: number, count: number, stride: number): number[] {
  const last = Math.min(first + SIDE, count - 1);
  const found = [];
  for (let one = first; one < last; one += stride) {
    found.push(one);
  }
  return [...found, last];
}

function vertex(mesh: Mesh, field: Field, design: Field | null, column: number, row: number): number | undefined {
  const z = field.at(column, row);
  if (z === undefined) {
    return undefined;
  }
  mesh.positions.push(field.x(column), field.y(row), z);
  const [dx, dy] = field.slope(column, row);
  const light = (SUN[2] - SUN[0] * dx - SUN[1] * dy) / Math.hypot(dx, dy, 1);
  const wanted = design?.at(column, row);
  const colour = wanted === undefined ? EARTH : mixed(EARTH, z > wanted ? CUT : FILL, Math.abs(z - wanted) / FULL);
  const shade = 0.35 + 0.75 * Math.max(0, light);
  mesh.colours.push(...colour.map((one) => Math.min(1, one * shade)));
  return mesh.positions.length / 3 - 1;
}

function mixed(one: Colour, other: Colour, part: number): Colour {
  const much = 0.65 * Math.min(1, part);
  const of = (index: 0 | 1 | 2) => one[index] + (other[index] - one[index]) * much;
  return [of(0), of(1), of(2)];
}

function quad(mesh: Mesh, a?: number, b?: number, c?: number, d?: number) {
  if (a !== undefined && b !== undefined && c !== undefined && d !== undefined) {
    mesh.triangles.push(a, b, c, a, c, d);
  }
}

/** A wall down from an edge. */
function skirt(mesh: Mesh, edge: readonly (number | undefined)[]) {
  const below = edge.map((index) => (index === undefined ? undefined : lowered(mesh, index)));
  for (let i = 0; i + 1 < edge.length; i += 1) {
    quad(mesh, edge[i], edge[i + 1], below[i + 1], below[i]);
  }
}

function lowered(mesh: Mesh, index: number): number {
  const [x = 0, y = 0, z = 0] = mesh.positions.slice(3 * index, 3 * index + 3);
  mesh.positions.push(x, y, z - SKIRT);
  mesh.colours.push(...mesh.colours.slice(3 * index, 3 * index + 3));
  return mesh.positions.length / 3 - 1;
}
