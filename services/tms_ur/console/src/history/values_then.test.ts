import { expect, test } from "vitest";
import { valuesThen } from "./values_then";

const change = (second: number, values: Record<string, number>) => ({
  stamp: new Date(second * 1000).toISOString(),
  source: "cli",
  values,
});

test("a record is what was written until then, field by field", () => {
  const changes = [change(30, { x: 3 }), change(20, { x: 2 }), change(10, { x: 1, y: 1 })]; // newest first
  expect(valuesThen(changes, 25_000)?.values).toEqual({ x: 2, y: 1 });
  expect(valuesThen(changes, 20_000)?.newest).toBe(changes[1]);
  expect(valuesThen(changes, 99_000)?.values).toEqual({ x: 3, y: 1 });
  expect(valuesThen(changes, 9_000)).toBeNull();
});
