import { describe, expect, test } from "vitest";
import type { Event } from "../models";
import { attemptsOf } from "./attempts";
import { countAt, journalOf } from "./journal";
import { momentAfter } from "./replay";

const BEGIN = Date.parse("2026-01-31T12:00:00Z");
const at = (seconds: number) => new Date(BEGIN + seconds * 1000).toISOString();
const TREE = { paths: ["0", "0.0"], names: ["", ""], types: ["", ""], kinds: ["", ""], ports: ["", ""] };

const event = (number: number, seconds: number, facts: Partial<Event>) =>
  ({ number, stamp: at(seconds), kind: "node", node: "0.0", text: "", values: {}, ...facts }) as Event;
const change = (number: number, seconds: number, before: string, state: string) =>
  event(number, seconds, { text: `dig ${before} -> ${state}` }); // as releases without reasons wrote it

const JOURNAL = journalOf(
  [
    event(1, 0, { kind: "tree", node: "", values: TREE }),
    change(2, 1, "IDLE", "RUNNING"),
    event(3, 2, { reason: { args: { old: "RUNNING", new: "FAILURE" } } as unknown as Event["reason"] as never }),
    change(4, 3, "FAILURE", "IDLE"),
    change(5, 4, "IDLE", "RUNNING"),
  ],
  false,
);

test("the tree is as it was at a time", () => {
  const then = (seconds: number) => momentAfter(JOURNAL, countAt(JOURNAL, BEGIN + seconds * 1000));
  expect(then(0)).toMatchObject({ digits: "00", leaf: "" });
  expect(then(1.5)).toMatchObject({ digits: "01", leaf: "0.0" });
  expect(then(2).digits).toBe("03");
  expect(then(3.9).digits).toBe("00");
  expect(then(3.9).last.get(1)).toBe("failure"); // the loop has set it back
  expect(then(9).digits).toBe("01");
});

test("a node's attempts have their times and ends", () => {
  const [first, second, ...more] = attemptsOf(JOURNAL, 5);
  expect(first).toMatchObject({ index: 1, begin: BEGIN + 1000, end: BEGIN + 2000, state: "failure" });
  expect(second).toMatchObject({ begin: BEGIN + 4000, end: null, state: "running" });
  expect(more).toEqual([]);
  expect(attemptsOf(JOURNAL, 2)).toMatchObject([{ end: null }]);
});

describe("times", () => {
  test("never fall, where the clock was set back", () => {
    const set = journalOf([event(1, 5, {}), event(2, 3, {}), event(3, 6, {})], false);
    expect(set.times).toEqual([5, 5, 6].map((seconds) => BEGIN + seconds * 1000));
    expect(countAt(set, BEGIN + 5000)).toBe(2);
    expect(countAt(set, BEGIN + 4999)).toBe(0);
  });
  test("are those of events around, where one has none", () => {
    const without = journalOf([event(1, 0, { stamp: null }), event(2, 3, {})], false);
    expect(without.times).toEqual([BEGIN + 3000, BEGIN + 3000]);
  });
});
