// @vitest-environment jsdom
import { configure, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { journalOf } from "../journal/journal";
import type { Event, ReasonView } from "../models";
import { Attempts } from "../tree/attempts";
import type { TreeNode } from "../tree/shape";
import { Cursor } from "./cursor";
import { lanesOf } from "./lanes";
import { gravityOf, type LogLine, linesUpTo, rowsOf as logRowsOf } from "./log_lines";
import { rowsOf } from "./rows";

configure({ asyncUtilTimeout: 60_000 }); // ms; a busy machine is no failure

const BEGIN = Date.parse("2026-01-31T12:00:00Z");
const event = (number: number, kind: string, text = "", facts: Partial<Event> = {}) =>
  ({
    number,
    stamp: new Date(BEGIN + number * 1000).toISOString(),
    kind,
    node: "",
    text,
    values: {},
    ...facts,
  }) as Event;
const words = (one: Event) => one.text;
const ALL = { kind: "", words: "", fold: false };

test("rows are the newest before the cursor, filtered", () => {
  const events = [event(1, "run", "begins"), event(2, "stop", "stood"), event(3, "run", "ends")];
  const shown = (count: number, wanted = {}) =>
    rowsOf(events, count, { ...ALL, ...wanted }, words).map((row) => row.event.number);
  expect(shown(3)).toEqual([3, 2, 1]);
  expect(shown(2)).toEqual([2, 1]);
  expect(shown(3, { kind: "run" })).toEqual([3, 1]);
  expect(shown(3, { words: "STOOD" })).toEqual([2]);
});

test("what a loop repeats is one row", () => {
  const polled = Array.from({ length: 300 }, (_, index) => event(index, "node", index % 2 === 0 ? "asks" : "waits"));
  expect(rowsOf(polled, 300, ALL, words).length).toBe(100);
  const rows = rowsOf(polled, 300, { ...ALL, fold: true }, words);
  expect(rows.map((row) => [row.event.number, row.times])).toEqual([
    [299, 150],
    [298, 150],
  ]);
});

test("log lines are the last ones up to the cursor", () => {
  const line = (second: number, level = "INFO") =>
    ({ time: new Date(BEGIN + second * 1000).toISOString(), process: "a:rc", level, text: `${second}` }) as LogLine;
  const rows = logRowsOf([1, 2, 2, 3].map((second) => line(second)));
  const shown = (second: number, most = 50) => linesUpTo(rows, BEGIN + second * 1000, most).map((row) => row.line.text);
  expect(shown(0)).toEqual([]);
  expect(shown(2)).toEqual(["1", "2", "2"]);
  expect(shown(9, 2)).toEqual(["2", "3"]);
  expect(["INFO", "", "WARNING", "ERROR", "CRITICAL"].map((level) => gravityOf(line(1, level)))).toEqual([
    "",
    "",
    "warning",
    "critical",
    "critical",
  ]);
});

const PORTS = ["", 'model_name="zx200" subtask_name="dig"', 'model_name="ic120" subtask_name="drive"'];
const same = PORTS.map(() => "");
const TREE = { paths: ["0", "0.0", "0.1"], names: same, types: same, kinds: same, ports: PORTS };
const JOURNAL = journalOf(
  [
    event(0, "tree", "", { values: TREE }),
    event(1, "node", "a IDLE -> RUNNING", { node: "0.0" }),
    event(2, "stop", "stood"),
    event(3, "node", "a RUNNING -> SUCCESS", { node: "0.0" }),
    event(4, "node", "b IDLE -> RUNNING", { node: "0.1" }),
    event(5, "stop", "stood"),
  ],
  false,
);

test("each machine has a lane of what it did", () => {
  const [zx200, ic120, ...more] = lanesOf(JOURNAL);
  expect(zx200).toMatchObject({ machine: "zx200", bars: [{ label: "dig", state: "success", end: BEGIN + 3000 }] });
  expect(ic120).toMatchObject({ machine: "ic120", bars: [{ label: "drive", state: "running", end: null }] });
  expect(more).toEqual([]);
});

test("the cursor jumps to stops, links to its moment, and plays to the end", async () => {
  const onTime = vi.fn();
  const { rerender } = render(
    <Cursor run="r-1" journal={JOURNAL} end={BEGIN + 5000} time={BEGIN + 2500} onTime={onTime} />,
  );
  fireEvent.click(screen.getByRole("button", { name: "Next stop" }));
  fireEvent.click(screen.getByRole("button", { name: "Stop before" }));
  expect(onTime.mock.calls.flat()).toEqual([BEGIN + 5000, BEGIN + 2000]);
  expect(screen.getByRole("link").getAttribute("href")).toBe("#history/r-1/2.5");
  onTime.mockClear();
  fireEvent.change(screen.getByRole("combobox"), { target: { value: "60" } });
  fireEvent.click(screen.getByRole("button", { name: /Play/ }));
  await waitFor(() => expect(onTime).toHaveBeenCalledWith(BEGIN + 5000)); // and not beyond it
  rerender(<Cursor run="r-1" journal={JOURNAL} end={BEGIN + 5000} time={BEGIN + 5000} onTime={onTime} />);
  expect(screen.getByRole("button", { name: /Play/ }).getAttribute("aria-pressed")).toBe("false");
});

test("a try that failed says why and what helps", () => {
  const both = (text: string) => ({ en: text, ja: text });
  const reason: ReasonView = {
    code: "X",
    args: {},
    text: both("it is not there"),
    details: both(""),
    action: { name: "logs", command: "", args: { process: "tms:db" }, text: both("Read its log") },
  };
  const events = [
    event(1, "tree", "", { values: { paths: ["0"] } }),
    event(2, "node", "dig IDLE -> RUNNING", { node: "0" }),
    event(3, "node", "dig RUNNING -> FAILURE", { node: "0", reason }),
  ];
  const node = { index: 0 } as TreeNode;
  render(<Attempts journal={journalOf(events, false)} count={3} now={BEGIN} node={node} />);
  expect(screen.getByText("it is not there")).toBeTruthy();
  expect(screen.getByRole("link", { name: "Read its log" }).getAttribute("href")).toBe("#system/tms%3Adb");
});
