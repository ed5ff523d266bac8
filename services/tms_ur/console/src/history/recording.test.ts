import { expect, test } from "vitest";
import type { Recording } from "../models";
import { indexAt, machinesAt, plotsOf, speedsOf, trailsAt, valuesAt } from "./recording";

const BEGIN = 1_769_860_800; // s
const TIMES = Array.from({ length: 51 }, (_, tick) => BEGIN + tick / 5);
const RECORDING: Recording = {
  series: [
    {
      machine: "ic120",
      kind: "load",
      names: ["mass", "bank", "loose"],
      times: [BEGIN + 3],
      values: [[1600], [0.8], [1]],
    },
    {
      machine: "ic120",
      kind: "pose",
      names: ["x", "y", "yaw"],
      times: TIMES,
      values: [TIMES.map((one) => (one - BEGIN) * 2), TIMES.map(() => 7), TIMES.map(() => 0.5)],
    },
    {
      machine: "zx200",
      kind: "joints",
      names: ["swing", "boom"],
      times: [BEGIN + 1, BEGIN + 2],
      values: [
        [0.1, 0.2],
        [-0.5, -0.6],
      ],
    },
    {
      machine: "zx200",
      kind: "pose",
      names: ["x", "y", "yaw"],
      times: TIMES,
      values: [TIMES.map(() => 1), TIMES.map(() => 2), TIMES.map(() => 0)],
    },
  ],
};
const series = (index: number) => RECORDING.series[index] ?? expect.fail();

test("the last value counts, with its age", () => {
  expect([0, 1, 1.5, 2, 9].map((second) => indexAt(series(2).times, BEGIN + second))).toEqual([-1, 0, 0, 1, 1]);
  expect(valuesAt(series(2), BEGIN)).toBeNull();
  expect(valuesAt(undefined, BEGIN)).toBeNull();
  const found = valuesAt(series(2), BEGIN + 5);
  expect(found?.age).toBe(3);
  expect([...(found?.values ?? [])]).toEqual([
    ["swing", 0.2],
    ["boom", -0.6],
  ]);
});

test("machines stand where they stood then, with their angles", () => {
  const [truck, excavator] = machinesAt(RECORDING, BEGIN + 1.1);
  expect(truck).toMatchObject({ name: "ic120", place: { x: 2, y: 7, yaw: 0.5 }, joints: [] });
  expect(excavator).toMatchObject({
    name: "zx200",
    place: { x: 1, y: 2, yaw: 0 },
    joints: [
      { name: "swing", position: 0.1 },
      { name: "boom", position: -0.5 },
    ],
  });
  expect(machinesAt(RECORDING, BEGIN - 1).map((one) => one.place)).toEqual([null, null]);
  expect(machinesAt(RECORDING, BEGIN + 60)[0]?.place_age).toBeCloseTo(50);
});

test("a trail ends where its machine was", () => {
  const trail = trailsAt(RECORDING, BEGIN + 4).get("ic120");
  expect(trail?.length).toBe(21);
  expect(trail?.at(-1)).toEqual([8, 7]);
});

test("who has stood has no speed, and what was not carried no load", () => {
  const speeds = speedsOf(series(1));
  expect(speeds[0]).toBe(0);
  expect(speeds.slice(1).every((one) => Math.abs(one - 2) < 1e-6)).toBe(true);
  expect(plotsOf(RECORDING, "ic120").map((one) => one.title)).toEqual(["plot_speed", "plot_load"]);
  const [joints, ...more] = plotsOf(RECORDING, "zx200");
  expect(joints?.lines.map((one) => one.name)).toEqual(["swing", "boom"]);
  expect(more).toEqual([]);
});
