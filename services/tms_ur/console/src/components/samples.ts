// What the components are shown with: made up, in all their states.
import type { Machine, ReasonView, Tree } from "../models";

const both = (text: string) => ({ en: text, ja: text });

export const reason = (name: string, args: Record<string, string>): ReasonView => ({
  code: "SAMPLE",
  args: {},
  text: both("zx200: not seen to stand"),
  details: both("boom_joint moved by 0.2 rad"),
  action: { name, args, text: both(name), command: "" },
});

const standing: Machine = {
  name: "armed",
  state: "standing",
  reason: null,
  goal: "",
  owner: "",
  armed: true,
  latch: null,
  hold: null,
  by_hand: "",
  since: null,
  last_stop: null,
  lamp: "automatic",
  watched: { people: null, hardware: {} },
  place: null,
  place_age: null,
  way: [],
  load: null,
  joints: [],
  joint_age: 0.1,
  age: 0.2,
};
const why = reason("records", {});

export const MACHINES: Machine[] = [
  standing,
  {
    ...standing,
    name: "moving",
    state: "moving",
    load: { mass: 1280, loose: 0.7, capacity: 0.92, measured: false },
    joints: [{ name: "boom_joint", position: -0.8, velocity: 0.1 }],
  },
  { ...standing, name: "latched", latch: why, last_stop: { stamp: "2026-01-31T09:05:00Z", confirmed: true } },
  { ...standing, name: "held", hold: why },
  { ...standing, name: "not_ready", state: "not_ready", reason: why },
  { ...standing, name: "by_hand", by_hand: "sato" },
  { ...standing, name: "silent", state: "silent", lamp: "fault", reason: why, joint_age: 12 },
];

const STATES = ["idle", "running", "success", "failure"];

/** A node of each state below its root, told apart by machine. */
export const TREE: Tree = {
  paths: ["0", ...STATES.map((_, index) => `0.${index}`)],
  names: ["Parallel", ...STATES],
  types: ["Parallel", ...STATES.map((_, index) => (index % 2 ? "LeafNodeIc120" : "LeafNodeZx200"))],
  kinds: ["control", ...STATES.map(() => "action")],
  ports: ["", ...STATES.map((_, index) => `model_name="${index % 2 ? "ic120" : "zx200"}"`)],
  templates: ["", "", "", "Dig:3", ""],
};
export const DIGITS = "10123";
