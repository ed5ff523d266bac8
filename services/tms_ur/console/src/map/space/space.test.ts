import { expect, test } from "vitest";
import { eased, type Shown } from "./ease";
import { Field, SIDE, strides, trianglesOf } from "./field";
import { draped } from "./lines";
import { meshOf } from "./mesh";

function field(columns: number, rows: number, height: (column: number, row: number) => number | null): Field {
  const cells = Array.from({ length: columns * rows }, (_, i) => height(i % columns, Math.floor(i / columns)));
  return new Field({ x0: -10, y0: 20, cell: 2, rows, columns, heights: cells, design: [] }, cells);
}

test("near tiles have all details, and all together keep the budget", () => {
  const tiles = field(300, 300, () => 0).tiles();
  const found = strides(tiles, [0, 30], 10, 48_000);
  expect(found[0]).toBe(1);
  expect(Math.max(...found)).toBeGreaterThan(2);
  expect(found.reduce((sum, one) => sum + trianglesOf(one), 0)).toBeLessThanOrEqual(48_000);
});

test("a tile covers its cells to the last one, however coarse", () => {
  for (const stride of [1, 4, 16]) {
    const ground = field(SIDE + 8, SIDE + 8, (column, row) => column + row);
    const xs = ground
      .tiles()
      .flatMap((tile) => meshOf(ground, null, tile, stride).positions.filter((_, i) => i % 3 === 0));
    expect([Math.min(...xs), Math.max(...xs)]).toEqual([ground.x(0), ground.x(SIDE + 7)]);
  }
});

test("what nobody knows has no surface", () => {
  const ground = field(3, 3, (column, row) => (column === 1 && row === 1 ? null : 1));
  const [tile] = ground.tiles();
  expect(tile && meshOf(ground, null, tile, 1).triangles.length / 3).toBe(4 * 4); // of the skirt only
  expect(ground.near(-5, 25)).toBe(1);
  expect(ground.near(1000, 0)).toBe(0);
});

test("soil that is to go is red, and soil that is missing blue", () => {
  const ground = field(2, 2, () => 1);
  const [tile] = ground.tiles();
  const colour = (design: number) =>
    tile &&
    meshOf(
      ground,
      field(2, 2, () => design),
      tile,
      1,
    ).colours.slice(0, 3);
  const [red = 0, , blue = 0] = colour(0) ?? [];
  expect(red).toBeGreaterThan(blue);
  const [red2 = 0, , blue2 = 0] = colour(2) ?? [];
  expect(blue2).toBeGreaterThan(red2);
});

test("machines turn the short way round, jump when they were moved, and come to rest", () => {
  const at = (x: number, yaw: number): Shown => ({ x, y: 0, yaw, angles: new Map([["swing_joint", yaw]]) });
  const { shown, moves } = eased(at(0, 3), at(1, -3), 0.05);
  expect(shown.x).toBeGreaterThan(0.3);
  expect(shown.yaw).toBeGreaterThan(3);
  expect(shown.angles.get("swing_joint")).toBeGreaterThan(3);
  expect(moves).toBe(true);
  expect(eased(at(0, 0), at(50, 0), 0.01).shown.x).toBe(50);
  expect(eased(at(1, 0), at(1.0001, 0), 0.01).moves).toBe(false);
});

test("a long way lies on the ground between its points", () => {
  expect(
    draped([
      [0, 0],
      [5, 0],
    ]).map(([x]) => x.toFixed(2)),
  ).toEqual(["0.00", "1.67", "3.33", "5.00"]);
});
