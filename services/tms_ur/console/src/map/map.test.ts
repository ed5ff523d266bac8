import { expect, test } from "vitest";
import type { SiteMachine, Stored } from "../models";
import { added, changed, clicked, cornerRemoved, documentOf, draftOf } from "./area_draft";
import { areasOf, flawOf, middle } from "./areas";
import { corners, hull, shadow } from "./outline";
import { links, placed, put } from "./pose";
import { fieldsOf, poseOf } from "./pose_record";
import { prisms } from "./shapes";
import { sideOf } from "./side_view";
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
  joints: [
    joint("base_joint", "base_link", "track_link", [0, 0, 0], 0, "y"),
    joint("swing_joint", "track_link", "body_link", [0.10787, -0.034301, 1.1206], 0, "z"),
    joint("boom_joint", "body_link", "boom_link", [0.22767, -0.040187, 0.83669], 0.5591284432, "y"),
    joint("arm_joint", "boom_link", "arm_link", [4.7878, 0.010957, 2.9959], 0.2961945914, "y"),
    joint("bucket_joint", "arm_link", "bucket_link", [1.8954, -0.023546, 2.1809], -0.1605847774, "y"),
  ],
  solids: [
    {
      link: "track_link",
      role: "track",
      y: [
        [-1.44, -0.75],
        [0.75, 1.44],
      ],
      outline: [
        [-2, 0],
        [2, 0],
        [2, 0.9],
        [-2, 0.9],
      ],
    },
    {
      link: "boom_link",
      role: "arm",
      y: [[-0.21, 0.29]],
      outline: [
        [0.05, -0.1],
        [4.74, 2.86],
        [2.27, 2.91],
        [-0.11, 0.03],
      ],
    },
  ],
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

test("each span of a solid is a prism, which its link carries", () => {
  const frames = links(EXCAVATOR, POSE, placed(0, 0, 0));
  const shapes = prisms(EXCAVATOR);
  expect(shapes.map((one) => [one.role, one.y0, one.y1])).toEqual([
    ["track", -1.44, -0.75],
    ["track", 0.75, 1.44],
    ["arm", -0.21, 0.29],
  ]);
  const arm = shapes.find((one) => one.link === "boom_link");
  const frame = frames.get("boom_link");
  const top = arm && frame ? Math.max(...corners(arm, frame).map(([, , z]) => z)) : 0;
  expect(top).toBeGreaterThan(3);
  expect(top).toBeLessThan(7);
  expect(arm && frame ? shadow(arm, frame).length : 0).toBeGreaterThanOrEqual(4);
});

test("the view from the side shows the arm straight ahead, whatever way the machine heads", () => {
  const ahead = sideOf(EXCAVATOR, prisms(EXCAVATOR), new Map([...POSE, ["swing_joint", Math.PI]]));
  expect(ahead.map((one) => one.role)).toEqual(["track", "track", "arm"]);
  const tip = ahead[2]?.points[1] ?? [0, 0];
  expect(tip[0]).toBeCloseTo(4.2, 1); // of the boom: ahead ...
  expect(tip[1]).toBeCloseTo(5.9, 1); // ... and up
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

test("a place is only good where the areas let machines be", () => {
  const square = (id: string, type: string, from: number, to: number) => ({
    id,
    type,
    corners: [
      [from, from],
      [to, from],
      [to, to],
      [from, to],
    ] as const,
  });
  const areas = [square("yard", "unmanned", 0, 10), square("pit", "blocked", 4, 6)].map((one) => ({
    ...one,
    corners: [...one.corners],
  }));
  expect(flawOf([2, 2], areas)).toBeNull();
  expect(flawOf([5, 5], areas)?.[0]).toBe("place_forbidden");
  expect(flawOf([12, 2], areas)?.[0]).toBe("place_outside");
  expect(flawOf([12, 2], [])).toBeNull();
});

test("a record keeps the form that it has, and a new one is a quaternion", () => {
  const stored = (values: Record<string, number>) => ({ values }) as unknown as Stored;
  const turned = stored({ x: 1, y: 2, z: 3, qx: 0, qy: 0, qz: Math.SQRT1_2, qw: Math.SQRT1_2 });
  expect(poseOf(turned)).toEqual({ x: 1, y: 2, heading: 90 });
  const written = (record: Stored | null) =>
    Object.fromEntries(fieldsOf({ x: 4, y: 5, heading: 180 }, record).map((one) => [one.name, one.value]));
  expect(Object.keys(written(turned))).toEqual(["x", "y", "qz", "qw"]);
  expect(written(turned).qz).toBeCloseTo(1);
  expect(written(stored({ x: 1, y: 2, yaw: 30 }))).toEqual({ x: 4, y: 5, yaw: 180 });
  expect(Object.keys(written(null)).sort()).toEqual(["qw", "qx", "qy", "qz", "x", "y", "z"]);
  expect(poseOf(stored({ angle: 1 }))).toBeNull();
});

test("clicks draw an area, take up a corner and put it down", () => {
  let draft = added(draftOf([]));
  for (const place of [
    [0, 0],
    [10, 0],
    [10, 10],
    [0, 10],
    [5, -1],
  ] as const) {
    draft = clicked(draft, place, 0.5);
  }
  const corners = () => draft.areas[0]?.corners;
  expect(corners()).toEqual([
    [0, 0],
    [5, -1],
    [10, 0],
    [10, 10],
    [0, 10],
  ]);
  draft = clicked(clicked(draft, [4.9, -1.1], 0.5), [5, 2.004], 0.5);
  expect(corners()?.[1]).toEqual([5, 2]);
  draft = cornerRemoved(clicked(draft, [5, 2], 0.5));
  expect(corners()?.length).toBe(4);
  expect(clicked(draftOf(draft.areas), [50, 50], 0.5).areas).toEqual(draft.areas); // none is chosen
});

test("a draft is written as areas are read, and says a speed only where it counts", () => {
  const square = [
    [0, 0],
    [1, 0],
    [1, 1],
  ] as const;
  let draft = changed(added(draftOf([])), { type: "speed_limit", corners: [...square] });
  const [feature] = documentOf(draft.areas).features;
  expect(feature?.properties).toEqual({ id: "area_1", type: "speed_limit", maximum_speed: 1 });
  expect(feature?.geometry.coordinates[0]?.length).toBe(4);
  draft = changed(draft, { type: "blocked" });
  expect(documentOf(draft.areas).features[0]?.properties).toEqual({ id: "area_1", type: "blocked" });
  expect(areasOf({ id: "a", by: "", areas: documentOf(draft.areas) })).toEqual(draft.areas);
});
