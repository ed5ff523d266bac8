// Bodies of machines as few prisms, made from the figures of the machine's file. Proportions that no file tells are
// ours; they are for eyes only, and nothing is decided by them.

import type { SiteMachine } from "../models";

export type Role = "track" | "body" | "arm" | "tool";

/** An outline in the x-z plane of a link, the same from y0 to y1 [m]. */
export interface Prism {
  link: string;
  role: Role;
  outline: readonly (readonly [number, number])[];
  y0: number;
  y1: number;
}

type Outline = [number, number][];

const BELT = 1.0; // m, height of tracks where no body tells one
const OVER = 0.4; // m that a belt is longer than where it touches the ground
const WALL = 0.08; // m
const CAB = 1.5; // m, length of a cab
const BEAM = 0.75; // m, thickness of a boom
const BLADE = 1.1; // m, height of a blade

export function prisms(machine: SiteMachine): Prism[] {
  return [...tracks(machine), ...bodies(machine), ...bucket(machine), ...vessel(machine), ...blade(machine)];
}

function box(x0: number, x1: number, z0: number, z1: number): Outline {
  return [
    [x0, z0],
    [x1, z0],
    [x1, z1],
    [x0, z1],
  ];
}

/** The lowest body of the base is that of the tracks. */
function beltHeight(machine: SiteMachine): number {
  const low = machine.footprint.find((one) => (one.min[2] ?? 0) === 0 && (one.max[2] ?? 0) < 1.5);
  return low?.max[2] ?? BELT;
}

function tracks(machine: SiteMachine): Prism[] {
  const told = machine.tracks;
  if (!told) {
    return [];
  }
  const [rear, front, top] = [told.rear - OVER, told.front + OVER, beltHeight(machine)];
  const outline: Outline = [
    [rear + OVER, 0],
    [front - OVER, 0],
    [front, top * 0.45],
    [front - OVER, top * 0.9],
    [rear + OVER, top * 0.9],
    [rear, top * 0.45],
  ];
  const belts = [-1, 1].map((side) => {
    const middle = (side * told.gauge) / 2;
    return {
      link: "base_link",
      role: "track" as const,
      outline,
      y0: middle - told.width / 2,
      y1: middle + told.width / 2,
    };
  });
  const inside = told.gauge / 2 - told.width / 2;
  const frame = box(told.rear, told.front, top * 0.4, top);
  return [...belts, { link: "base_link", role: "body", outline: frame, y0: -inside, y1: inside }];
}

/** Boxes of links: what turns on the tracks gets a cab, what hangs on that is a beam; tools have shapes of their own. */
function bodies(machine: SiteMachine): Prism[] {
  const tools = [machine.bucket?.link, machine.vessel?.link, machine.blade?.link];
  const shown = machine.bodies.filter((one) => !tools.includes(one.link) && one.link !== "track_link");
  const found = shown.flatMap((one) => {
    const [x0 = 0, y0 = 0, z0 = 0] = one.min;
    const [x1 = 0, y1 = 0, z1 = 0] = one.max;
    const { link } = one;
    if (machine.joints.some((joint) => joint.child === link && joint.axis === "z")) {
      return upper(link, [x0, x1], [y0, y1], [z0, z1]);
    }
    const outline = pitched(beam(x0, x1, z0, z1), one.pitch);
    const half = Math.min(0.35, (y1 - y0) / 2);
    return [{ link, role: "arm" as const, outline, y0: (y0 + y1) / 2 - half, y1: (y0 + y1) / 2 + half }];
  });
  return found.length > 0 ? found : cabOfCarrier(machine);
}

type Span = readonly [number, number];

function upper(link: string, [x0, x1]: Span, [y0, y1]: Span, [z0, z1]: Span): Prism[] {
  const middle = z0 + (z1 - z0) * 0.6;
  const engine: Outline = [
    [x0 + 0.2, z0],
    [x1 + CAB, z0],
    [x1 + CAB, z0 + 0.25],
    [x1, z0 + 0.25],
    [x1 - 0.3, middle],
    [x0, middle],
    [x0, z0 + 0.4],
  ];
  const front = x1 + CAB;
  const cab: Outline = [
    [x1 - 0.2, z0 + 0.2],
    [front, z0 + 0.2],
    [front + 0.05, z0 + (z1 - z0) * 0.65],
    [front - 0.25, z1 + 0.3],
    [x1, z1 + 0.3],
  ];
  return [
    { link, role: "body", outline: engine, y0, y1 },
    { link, role: "body", outline: cab, y0: y1 - 1.0, y1 },
  ];
}

/** A beam that is bent upwards, along the line of its pins. */
function beam(x0: number, x1: number, z0: number, z1: number): Outline {
  const bend = x0 + (x1 - x0) * 0.42;
  return [
    [x0, z0],
    [bend, Math.max(z0, z1 - BEAM)],
    [x1, z0],
    [x1, Math.min(z1, z0 + 0.35)],
    [bend, z1],
    [x0, Math.min(z1, z0 + 0.35)],
  ];
}

/** Points of a frame that is turned about y. */
function pitched(outline: Outline, pitch: number): Outline {
  const [c, s] = [Math.cos(pitch), Math.sin(pitch)];
  return outline.map(([x, z]) => [c * x + s * z, -s * x + c * z]);
}

/** A carrier has a deck below its vessel and a cab before it; another machine one body on its tracks. */
function cabOfCarrier(machine: SiteMachine): Prism[] {
  const vessel = machine.vessel;
  const pin = machine.joints.find((one) => one.child === vessel?.link);
  if (!vessel || !pin) {
    const body = machine.footprint[0];
    const top = body?.max[2] ?? 2;
    const whole = box((machine.tracks?.rear ?? -1) - 0.2, (machine.tracks?.front ?? 1) + 0.2, 0.7, top * 0.55);
    const seat = box(-1.2, 0.4, top * 0.55, top);
    return [whole, seat].map((outline) => ({ link: "base_link", role: "body", outline, y0: -0.7, y1: 0.7 }));
  }
  const [x = 0, , z = 0] = pin.xyz;
  const front = x + (vessel.max[0] ?? 0) + 0.4;
  const [y0, y1] = [vessel.min[1] ?? -1, vessel.max[1] ?? 1];
  const deck = box(x, front + CAB, z - 0.35, z - 0.1);
  const cab: Outline = [
    [front, z - 0.1],
    [front + CAB, z - 0.1],
    [front + CAB, z + 0.8],
    [front + CAB - 0.3, z + 1.9],
    [front, z + 1.9],
  ];
  return [
    { link: pin.parent, role: "body", outline: deck, y0, y1 },
    { link: pin.parent, role: "body", outline: cab, y0: y0 * 0.9, y1: y1 * 0.9 },
  ];
}

/** Its inner section, closed over its opening. */
function bucket(machine: SiteMachine): Prism[] {
  const told = machine.bucket;
  if (!told) {
    return [];
  }
  const outline = told.section.map(([x = 0, z = 0]) => [x, z] as [number, number]);
  return [{ link: told.link, role: "tool", outline, y0: -told.width / 2, y1: told.width / 2 }];
}

/** Floor, front and sides; it tips over the end without a wall. */
function vessel(machine: SiteMachine): Prism[] {
  const told = machine.vessel;
  if (!told) {
    return [];
  }
  const [x0 = 0, y0 = 0, z0 = 0] = told.min;
  const [x1 = 0, y1 = 0, z1 = 0] = told.max;
  const link = { link: told.link, role: "tool" as const };
  const side = box(x0, x1, z0 - WALL, z1);
  return [
    { ...link, outline: box(x0, x1, z0 - WALL, z0), y0, y1 },
    { ...link, outline: box(x1, x1 + WALL, z0 - WALL, z1 + 0.2), y0: y0 - WALL, y1: y1 + WALL },
    { ...link, outline: side, y0: y0 - WALL, y1: y0 },
    { ...link, outline: side, y0: y1, y1: y1 + WALL },
  ];
}

function blade(machine: SiteMachine): Prism[] {
  const told = machine.blade;
  if (!told) {
    return [];
  }
  const [x = 0, z = 0] = told.edge;
  const outline: Outline = [
    [x, z],
    [x - 0.25, z + BLADE / 3],
    [x - 0.25, z + (2 * BLADE) / 3],
    [x, z + BLADE],
    [x - 0.1, z + BLADE],
    [x - 0.4, z + BLADE / 2],
    [x - 0.1, z],
  ];
  return [{ link: told.link, role: "tool", outline, y0: -told.width / 2, y1: told.width / 2 }];
}
