import { expect, test } from "vitest";
import type { SiteMachine } from "../models";
import { areasOf, middle } from "./areas";
import { corners, hull, shadow } from "./outline";
import { links, placed, put } from "./pose";
import { prisms } from "./shapes";
import { lengthened } from "./trails";
import { dragged, fitted, gridStep, placeAt, zoomed } from "./view";

const joint = (name: string, parent: string, child: string, xyz: number[], pitch: number, axis: string) => ({
  joint: name,
  parent,
  child,
  xyz,
  pitch,
  axis,
});

/** The zx200 of configs/machines. */
const EXCAVATOR: SiteMachine = {
  name: "zx200",
  model: "zx200",
  kind: "backhoe",
  footprint: [{ min: [-2, -1.8, 0], max: [2.3, 1.7, 1.121] }],
  arm: [],
  joints: [
    joint("base_joint", "base_link", "track_link", [0, 0, 0], 0, "y"),
    joint("swing_joint", "track_link", "body_link", [0.10787, -0.034301, 1.1206], 0, "z"),
    joint("boom_joint", "body_link", "boom_link", [0.22767, -0.040187, 0.83669], 0.5591284432, "y"),
    joint("arm_joint", "boom_link", "arm_link", [4.7878, 0.010957, 2.9959], 0.2961945914, "y"),
    joint("bucket_joint", "arm_link", "bucket_link", [1.8954, -0.023546, 2.1809], -0.1605847774, "y"),
  ],
  bodies: [
    { link: "track_link", min: [-2.015, -1.838, 0], max: [2.335, 1.74, 1.121], pitch: 0 },
    { link: "body_link", min: [-2.896, -1.274, 0], max: [0.2, 1.509, 2], pitch: 0 },
    { link: "boom_link", min: [-0.11, -0.405, -0.16], max: [5.66, 0.483, 1.28], pitch: -0.5591 },
    { link: "arm_link", min: [-0.4, -0.25, -0.3], max: [2.9, 0.25, 0.4], pitch: -0.8555 },
    { link: "bucket_link", min: [-0.3, -0.569, -0.1], max: [1.257, 0.557, 1.05], pitch: 0 },
  ],
  bucket: {
    link: "bucket_link",
    section: [
      [0.06, -0.08],
      [-0.14, 0.48],
      [0.56, 0.87],
      [1.24, 0.8],
    ],
    width: 1.05,
  },
  vessel: null,
  blade: null,
  tracks: { rear: -1.685, front: 1.685, gauge: 2.19, width: 0.69 },
};
const POSE = new Map([
  ["boom_joint", -0.8029],
  ["arm_joint", 1.9897],
  ["bucket_joint", 0.8029],
]);

test("links are where the joints put them", () => {
  const tip = (angles: Map<string, number>, yaw = 0) => {
    const frame = links(EXCAVATOR, angles, placed(10, 20, yaw)).get("bucket_link") ?? [];
    return put(frame, [1.2, 0, 1]).map((one) => Number(one.toFixed(2)));
  };
  const [x = 0, y = 0, z = 0] = tip(POSE);
  expect(y).toBeCloseTo(19.91, 1);
  const turned = tip(new Map([...POSE, ["swing_joint", Math.PI / 2]]));
  expect(turned[0]).toBeCloseTo(10.2, 0); // to the left
  expect(turned[1]).toBeCloseTo(20 + x - 10, 0);
  expect(turned[2]).toBeCloseTo(z, 2);
  expect(tip(new Map([...POSE, ["boom_joint", -1.0]]))[2]).toBeGreaterThan(z); // less is up
});

test("bodies follow the figures of the machine's file, and cover it from above", () => {
  const frames = links(EXCAVATOR, POSE, placed(0, 0, 0));
  const shapes = prisms(EXCAVATOR);
  expect(new Set(shapes.map((one) => one.link))).toEqual(
    new Set(["base_link", "body_link", "boom_link", "arm_link", "bucket_link"]),
  );
  const belts = shapes.filter((one) => one.role === "track");
  expect(belts.map((one) => [one.y0, one.y1])).toEqual(
    [
      [-1.44, -0.75],
      [0.75, 1.44],
    ].map((pair) => pair.map((y) => expect.closeTo(y, 5))),
  );
  const arm = shapes.find((one) => one.link === "boom_link");
  const frame = frames.get("boom_link");
  const top = arm && frame ? Math.max(...corners(arm, frame).map(([, , z]) => z)) : 0;
  expect(top).toBeGreaterThan(3);
  expect(top).toBeLessThan(7);
  expect(arm && frame ? shadow(arm, frame).length : 0).toBeGreaterThanOrEqual(4);
});

test("a carrier has a vessel without a rear wall, a deck and a cab", () => {
  const carrier: SiteMachine = {
    ...EXCAVATOR,
    joints: [joint("vessel_pin_joint", "base_link", "vessel_link", [-3.0153, 0, 0.94605], 0, "y")],
    bodies: [{ link: "vessel_link", min: [-0.583, -1.283, -0.087], max: [3.739, 1.317, 1.926], pitch: 0 }],
    bucket: null,
    vessel: { link: "vessel_link", min: [0.15, -0.875, 0.2], max: [3.11, 0.875, 1.3] },
  };
  expect(prisms(carrier).map((one) => one.role)).toEqual([
    "track",
    "track",
    "body",
    "body",
    "body",
    "tool",
    "tool",
    "tool",
    "tool",
  ]);
});

test("a hull has no points inside", () => {
  expect(
    hull([
      [0, 0],
      [2, 0],
      [1, 0.5],
      [2, 2],
      [0, 2],
      [1, 0],
    ]),
  ).toEqual([
    [0, 0],
    [2, 0],
    [2, 2],
    [0, 2],
  ]);
});

test("the view keeps the place under the pointer, and moves as a hand moves paper", () => {
  const size = { width: 800, height: 600 };
  const view = fitted(
    [
      [0, 0],
      [100, 50],
    ],
    size,
  );
  expect(placeAt(view, size, 400, 300)).toEqual([50, 25]);
  const before = placeAt(view, size, 100, 500);
  const near = zoomed(view, size, 3, 100, 500);
  expect(placeAt(near, size, 100, 500).map((one) => one.toFixed(6))).toEqual(before.map((one) => one.toFixed(6)));
  const moved = dragged(view, 70, -30);
  expect(placeAt(moved, size, 470, 270).map((one) => one.toFixed(6))).toEqual(["50.000000", "25.000000"]);
  expect(zoomed(view, size, 1e9, 0, 0).scale).toBe(200);
  expect(gridStep(10) * 10).toBeGreaterThanOrEqual(30);
});

test("a trail grows with the way, not with the time", () => {
  const trail = lengthened(lengthened([], [0, 0]), [0.1, 0]);
  expect(trail).toEqual([[0, 0]]);
  expect(lengthened(trail, [1, 0])).toEqual([
    [0, 0],
    [1, 0],
  ]);
});

test("areas of a document", () => {
  const coordinates = [
    [
      [0, 0],
      [4, 0],
      [4, 2],
      [0, 2],
      [0, 0],
    ],
  ];
  const feature = { properties: { id: "yard", type: "unmanned" }, geometry: { coordinates } };
  const [area] = areasOf({ id: "9f", by: "", areas: { features: [feature] } });
  expect(area?.corners.length).toBe(4);
  expect(middle(area?.corners ?? [])).toEqual([2, 1]);
  expect(areasOf(null)).toEqual([]);
});
