import { expect, test } from "vitest";
import { journalOf } from "../journal/journal";
import type { Event } from "../models";
import { HEIGHT, placed, WIDTH } from "./layout";
import { linesTo } from "./lines";
import { above, matching, nodesOf, openPaths, stateOf } from "./shape";
import { spentIn } from "./spent";
import { bandOf } from "./use_boxes";

/** A root with branches of equally many leaves. */
function made(branches: number, leaves: number) {
  const paths = ["0"];
  for (let i = 0; i < branches; i += 1) {
    paths.push(`0.${i}`, ...Array.from({ length: leaves }, (_, j) => `0.${i}.${j}`));
  }
  const same = (text: string) => paths.map(() => text);
  const ports = paths.map((path) => (path.split(".").length === 3 ? 'model_name="zx200" subtask_name="dig"' : ""));
  return { paths, names: same("n"), types: same("n"), kinds: same("control"), ports, templates: [] };
}

const running = (paths: string[], ...on: string[]) => paths.map((path) => (on.includes(path) ? "1" : "2")).join("");

test("nodes know their children, machine and goal", () => {
  const nodes = nodesOf(made(2, 1));
  expect(nodes.get("0")?.children.map((node) => node.path)).toEqual(["0.0", "0.1"]);
  expect(nodes.get("0.1.0")).toMatchObject({ machine: "zx200", label: "dig", children: [] });
});

test("a large tree is open where it runs, and where a person has opened it", () => {
  const tree = made(27, 9);
  const nodes = nodesOf(tree);
  const digits = running(tree.paths, "0", "0.4", "0.4.1");
  expect(stateOf({ index: 1 }, digits)).toBe("success");
  expect([...openPaths(nodes, digits, new Map())]).toEqual(["0", "0.4"]);
  const byHand = new Map([
    ["0.4", false],
    ["0.7", true],
  ]);
  expect([...openPaths(nodes, digits, byHand)]).toEqual(["0", "0.7"]);
  expect(openPaths(nodesOf(made(2, 2)), "", new Map()).size).toBe(3); // a small one as a whole
});

test("no two nodes stand on each other, and parents above their children", () => {
  const nodes = nodesOf(made(27, 9));
  const root = nodes.get("0");
  const places = root === undefined ? [] : placed(root, new Set(nodes.keys()));
  expect(places.length).toBe(271);
  const rows = Map.groupBy(places, (one) => one.y);
  expect([...rows.keys()].sort((a, b) => a - b).every((y, i, all) => i === 0 || y - (all[i - 1] ?? 0) > HEIGHT)).toBe(
    true,
  );
  for (const row of rows.values()) {
    const xs = row.map((one) => one.x).sort((a, b) => a - b);
    expect(xs.every((x, i) => i === 0 || x - (xs[i - 1] ?? 0) > WIDTH)).toBe(true);
  }
});

test("a branch knows whose machines work in it", () => {
  const tree = made(2, 2);
  const ports = tree.ports.map((text, index) => (index > 3 ? text.replace("zx200", "ic120") : text));
  const nodes = nodesOf({ ...tree, ports });
  expect([...nodes.values()].map((node) => node.team.join())).toEqual([
    "zx200,ic120",
    ...["zx200", "zx200", "zx200"],
    ...["ic120", "ic120", "ic120"],
  ]);
  const machines = nodes.get("0")?.team ?? [];
  expect(["0", "0.0", "0.1.1"].map((path) => bandOf(nodes.get(path)?.team ?? [], machines))).toEqual([0, 1, 2]);
});

test("all words of a search must be in a node", () => {
  const nodes = nodesOf(made(2, 2));
  const found = (words: string) => matching(nodes, words).map((node) => node.path);
  expect(found("DIG 0.1.")).toEqual(["0.1.0", "0.1.1"]);
  expect([found(" "), found("dig haul")]).toEqual([[], []]);
  expect(above("0.1.0")).toEqual(["0", "0.1"]);
});

test("every node but the root has a line, in the path of its kind", () => {
  const root = nodesOf(made(2, 1)).get("0");
  const places = root === undefined ? [] : placed(root, null);
  const lines = linesTo(places, ({ path }) => (path.startsWith("0.1") ? "b" : "a"));
  expect([...lines.keys()]).toEqual(["a", "b"]);
  expect([...lines.values()].map((line) => line.split("M").length - 1)).toEqual([2, 2]);
});

test("the tries of a node are added up, and compared with nodes of its kind", () => {
  const tree = made(1, 2);
  const at = (number: number, node: string, text: string, seconds: number): Event =>
    ({ number, node, text, kind: "node", stamp: new Date(seconds * 1000).toISOString(), values: {} }) as Event;
  const events = [
    { ...at(1, "", "", 0), kind: "tree", values: { ...tree } } as Event,
    at(2, "0", "n IDLE -> RUNNING", 0),
    at(3, "0.0.0", "n IDLE -> RUNNING", 0),
    at(4, "0.0.0", "n RUNNING -> FAILURE", 1),
    at(5, "0.0.0", "n FAILURE -> RUNNING", 2),
    at(6, "0.0.0", "n RUNNING -> SUCCESS", 5),
    at(7, "0.0.1", "n IDLE -> RUNNING", 5),
  ];
  const spent = spentIn(journalOf(events, false), events.length, 6000);
  expect([...spent]).toEqual([
    [0, { seconds: 6, heat: 4 }],
    [2, { seconds: 4, heat: 4 }],
    [3, { seconds: 1, heat: 1 }],
  ]);
});
