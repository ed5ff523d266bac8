import { expect, test } from "vitest";
import type { State } from "../models";
import { addressOf, chosenOf } from "./chosen";
import { linesWith } from "./log";
import { groupsOf } from "./rows";

test("essential processes stand apart from those on demand, what is down first in each", () => {
  const process = (name: string, state: string, on_demand = false) => ({ name, state, on_demand });
  const hosts = [
    { name: "pc", age: 0, processes: [process("a:st", "STOPPED", true), process("a:rc", "RUNNING")] },
    { name: "cps", age: 0, processes: [process("tms:db", "STOPPED"), process("b:st", "FATAL", true)] },
  ];
  const names = (words: string) => {
    const { essential, onDemand } = groupsOf({ hosts } as unknown as State, words);
    return [essential, onDemand].map((rows) => rows.map((row) => row.process.name));
  };
  expect(names("")).toEqual([
    ["tms:db", "a:rc"],
    ["b:st", "a:st"],
  ]);
  expect(names("PC")).toEqual([["a:rc"], ["a:st"]]);
});

test.each([
  ["", { kind: "process", name: "" }, "#system"],
  ["zx200%3Arc", { kind: "process", name: "zx200:rc" }, "#system/zx200:rc"],
  ["machine/zx200", { kind: "machine", name: "zx200" }, "#system/machine/zx200"],
  ["run/r-1", { kind: "run", name: "r-1" }, "#system/run/r-1"],
] as const)("the address %s names a log", (rest, chosen, address) => {
  expect(chosenOf(rest)).toEqual(chosen);
  expect(addressOf(chosen)).toBe(address);
});

test("a log is searched for lines with all of the words", () => {
  const text = "INFO run=r-1 event=begun\nWARNING run=r-1 event=late\nINFO run=r-2 event=late";
  expect(linesWith(text, "r-1  LATE")).toBe("WARNING run=r-1 event=late");
  expect(linesWith(text, "")).toBe(text);
});
