import { describe, expect, test } from "vitest";
import type { ActiveRun, Machine, ReasonView, State } from "../models";
import { doingOf } from "./doing";
import { lightOf } from "./light";

const WHY = { code: "SOFTWARE_STOP", text: { en: "stop", ja: "停止" } } as ReasonView;
const machine = (name: string, facts: Partial<Machine> = {}) =>
  ({
    name,
    state: "standing",
    latch: null,
    hold: null,
    by_hand: "",
    watched: { people: null, hardware: {} },
    ...facts,
  }) as Machine;
const site = (machines: Machine[], facts: Partial<State> = {}) =>
  ({ machines, runs: [], questions: [], hosts: [], scheduler: { alive: true, age: 0 }, ...facts }) as unknown as State;

describe("the light of the site", () => {
  const armed = machine("a");
  test.each([
    ["ready", [armed], 0],
    ["moving", [armed, machine("b", { state: "moving" })], 0],
    ["attention", [armed, machine("b", { hold: WHY })], 0],
    ["attention", [machine("a", { state: "silent" })], 0],
    ["attention", [armed], 1],
    ["attention", [machine("a", { watched: { people: WHY, hardware: {} } })], 0],
    ["stopped", [machine("a", { state: "moving" }), machine("b", { latch: WHY })], 1],
  ])("is %s", (light, machines, needed) => {
    expect(lightOf(site(machines), true, needed).light).toBe(light);
  });

  test("waits for a person while the scheduler says nothing", () => {
    expect(lightOf(site([armed], { scheduler: { alive: false, age: 6 } }), true, 0).light).toBe("attention");
  });

  test("names the machines that make it so", () => {
    const machines = [armed, machine("b", { latch: WHY })];
    expect(lightOf(site(machines), true, 0).machines).toEqual(["b"]);
  });

  test.each([false, null])("is unknown without a connection (%s)", (link) => {
    expect(lightOf(site([machine("a", { latch: WHY })]), link, 0).light).toBe("unknown");
  });
});

test("a machine does what the running leaves with its name do", () => {
  const run = { run_id: "r", nodes: "1112" } as ActiveRun;
  const ports = [
    "",
    'model_name="zx200" subtask_name="dig" record_name="PILE"',
    'subtask_name="haul" model_name="ic120"',
    'model_name="zx200" subtask_name="release"',
  ];
  const tree = { paths: ["0", "0.0", "0.1", "0.2"], names: [], types: [], kinds: [], ports, templates: [] };
  expect(doingOf("zx200", run, tree)).toEqual([{ subtask: "dig", record: "PILE" }]);
  expect(doingOf("ic120", run, tree)).toEqual([{ subtask: "haul", record: "" }]);
  expect(doingOf("zx200", run, null)).toEqual([]);
});
