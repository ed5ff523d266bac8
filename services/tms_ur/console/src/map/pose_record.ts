// A record that holds one place with a heading, as subtasks that drive to a place read it.

import type { Stored } from "../models";

export interface Pose {
  x: number; // m, map
  y: number;
  heading: number; // deg, anticlockwise from x
}

type Field = { name: string; type: "double"; value: number };

const number = (record: Stored, name: string) => {
  const value = record.values[name];
  return typeof value === "number" ? value : undefined;
};

const degrees = (angle: number) => (angle * 180) / Math.PI;

/** The pose of a record; null where it holds no place, or a path. */
export function poseOf(record: Stored): Pose | null {
  const [x, y] = [number(record, "x"), number(record, "y")];
  if (x === undefined || y === undefined) {
    return null;
  }
  const yaw = number(record, "yaw") ?? degrees(2 * Math.atan2(number(record, "qz") ?? 0, number(record, "qw") ?? 1));
  return { x, y, heading: Math.round(yaw * 100) / 100 };
}

/** What to write into a record, in the form that it has; into a new one as a quaternion. */
export function fieldsOf({ x, y, heading }: Pose, record: Stored | null): Field[] {
  const half = (heading * Math.PI) / 360;
  const turned = { qz: Math.sin(half), qw: Math.cos(half) };
  const whole = { z: 0, qx: 0, qy: 0, ...turned };
  const angle = record === null ? whole : number(record, "yaw") !== undefined ? { yaw: heading } : turned;
  const known = Object.entries(angle).filter(([name]) => record === null || name in record.values);
  return [["x", x] as const, ["y", y] as const, ...known].map(([name, value]) => ({ name, type: "double", value }));
}
