import { expect, test } from "vitest";
import { keptFor } from "./use_ground_then";

const TAKEN = "2026-11-26T12:00:00Z";
const NEXT = "2026-11-26T13:00:00Z";
const NOTHING = { x0: 0, y0: 0, cell: 1, rows: 0, columns: 0, heights: [], design: [] };
const TIME = Date.parse(TAKEN) + 60_000;

test("a ground is true until the next one", () => {
  const kept = keptFor({ ...NOTHING, taken_at: TAKEN, next_at: NEXT }, TIME);
  expect([kept.from, kept.to]).toEqual([Date.parse(TAKEN), Date.parse(NEXT)]);
});

test("the newest one is asked for again after a while", () => {
  const kept = keptFor({ ...NOTHING, taken_at: TAKEN }, TIME);
  expect(kept.from).toBe(Date.parse(TAKEN));
  expect(kept.to).toBe(TIME + 600_000);
});
