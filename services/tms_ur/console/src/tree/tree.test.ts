import { expect, test } from "vitest";
import { HEIGHT, placed, WIDTH } from "./layout";
import { nodesOf, openPaths, stateOf } from "./shape";

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
