// @vitest-environment jsdom
import { expect, test } from "vitest";
import type { RecordChange, Stored } from "../models";
import { linesOf } from "./series";
import { exact, listed, typed } from "./values";

test("a value keeps its type when it is shown, edited and read back", () => {
  expect(exact(3, "double")).toBe("3.0");
  expect(exact([1, 2.5], "double[]")).toBe("[1.0, 2.5]");
  expect(typed("angle", "double[]", "[1.0, 2.5]")).toEqual({ name: "angle", type: "double[]", value: [1, 2.5] });
  expect(typed("name", "string", "3")).toEqual({ name: "name", type: "string", value: "3" });
  expect(() => typed("angle", "double", "far")).toThrow(/angle.*far.*-1\.05/);
  expect(() => typed("", "double", "1")).toThrow();
});

test("values are listed with six digits and their units", () => {
  const record = { types: { x: "double", n: "int" }, units: { x: "m" } } as unknown as Stored;
  expect(listed({ x: 1.23456789, n: 3 }, record)).toBe("x: 1.23457 m, n: 3");
});

test("the numbers of a record's history are lines by time", () => {
  const at = (second: number) => `2026-01-31T12:00:0${second}Z`;
  const changes = [
    { stamp: at(3), source: "", values: { y: 5 } },
    { stamp: at(1), source: "", values: { x: 1, y: 2, name: "a" } },
  ] as RecordChange[]; // newest first
  const { times, lines } = linesOf(changes);
  expect(times).toEqual([at(1), at(3)].map((stamp) => Date.parse(stamp) / 1000));
  expect(lines).toEqual([
    { name: "x", values: [1, null] },
    { name: "y", values: [2, 5] },
  ]);
});
