import { expect, test } from "vitest";
import type { State } from "../models";
import { linesWith } from "./log";
import { rowsOf } from "./rows";

test("what is down comes first, what waits for work last", () => {
  const process = (name: string, state: string, on_demand = false) => ({ name, state, on_demand });
  const hosts = [
    { name: "pc", age: 0, processes: [process("a:st", "STOPPED", true), process("a:rc", "RUNNING")] },
    { name: "cps", age: 0, processes: [process("tms:db", "STOPPED"), process("b:st", "FATAL", true)] },
  ];
  const names = (words: string) => rowsOf({ hosts } as unknown as State, words).map((row) => row.process.name);
  expect(names("")).toEqual(["tms:db", "b:st", "a:rc", "a:st"]);
  expect(names("PC")).toEqual(["a:rc", "a:st"]);
});

test("a log is searched for lines with all of the words", () => {
  const text = "INFO run=r-1 event=begun\nWARNING run=r-1 event=late\nINFO run=r-2 event=late";
  expect(linesWith(text, "r-1  LATE")).toBe("WARNING run=r-1 event=late");
  expect(linesWith(text, "")).toBe(text);
});
