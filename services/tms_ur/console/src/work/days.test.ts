import { expect, test } from "vitest";
import type { WorkSum } from "../models";
import { dayBeside, hoursOf, partsOf } from "./days";

test("the day before the first of a month", () => {
  expect(dayBeside("2026-03-01", -1)).toBe("2026-02-28");
  expect(dayBeside("2026-12-31", 1)).toBe("2027-01-01");
});

test("hours are compared with the best one", () => {
  const hours = [
    { name: "09", bank: 2 },
    { name: "10", bank: 4 },
  ] as WorkSum[];
  expect(hoursOf(hours).map(({ share }) => share)).toEqual([0.5, 1]);
  expect(hoursOf([{ name: "11", bank: 0 } as WorkSum])[0]?.share).toBe(0);
});

test("parts come with their share, the longest first", () => {
  expect(partsOf({ dig: 60, dump: 180 })).toEqual([
    { name: "dump", minutes: 3, share: 0.75 },
    { name: "dig", minutes: 1, share: 0.25 },
  ]);
});
