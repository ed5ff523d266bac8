// Where the links of a machine are, from its place and the angles of its joints.

import type { Machine, SiteMachine } from "../models";

/** A frame in another one: three rows of a rotation and a translation [m]. */
export type Frame = readonly number[];
export type Point = readonly [number, number, number]; // m

type Axis = 0 | 1 | 2;
const AXES: Record<string, Axis> = { x: 0, y: 1, z: 2 };

/** On flat ground of height z, turned about the vertical. */
export function placed(x: number, y: number, yaw: number, z = 0): Frame {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return [c, -s, 0, x, s, c, 0, y, 0, 0, 1, z];
}

const at = (frame: Frame, index: number) => frame[index] ?? 0;

/** Frame `b`, which is told in frame `a`, in the frame in which `a` is told. */
export function times(a: Frame, b: Frame): Frame {
  const found: number[] = [];
  for (let row = 0; row < 12; row += 4) {
    for (let column = 0; column < 4; column += 1) {
      const turned = [0, 1, 2].reduce((sum, k) => sum + at(a, row + k) * at(b, 4 * k + column), 0);
      found.push(turned + (column === 3 ? at(a, row + 3) : 0));
    }
  }
  return found;
}

/** A rotation about one axis by an angle [rad], at a place [m]. */
function turned(axis: Axis, angle: number, xyz: readonly number[] = [0, 0, 0]): Frame {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [i, j] = [((axis + 1) % 3) as Axis, ((axis + 2) % 3) as Axis];
  const found = [1, 0, 0, at(xyz, 0), 0, 1, 0, at(xyz, 1), 0, 0, 1, at(xyz, 2)];
  found[4 * i + i] = found[4 * j + j] = c;
  found[4 * i + j] = -s;
  found[4 * j + i] = s;
  return found;
}

/** A point of a frame, told in the frame in which that is told. */
export function put(frame: Frame, [x, y, z]: Point): Point {
  const row = (k: number) => at(frame, k) * x + at(frame, k + 1) * y + at(frame, k + 2) * z + at(frame, k + 3);
  return [row(0), row(4), row(8)];
}

/** All links of a machine whose base_link is at `base`. */
export function links(body: SiteMachine, angles: ReadonlyMap<string, number>, base: Frame): Map<string, Frame> {
  const found = new Map([["base_link", base]]);
  for (const one of body.joints) {
    const parent = found.get(one.parent);
    if (parent !== undefined) {
      const fixed = times(parent, turned(1, one.pitch, one.xyz));
      found.set(one.child, times(fixed, turned(AXES[one.axis] ?? 1, angles.get(one.joint) ?? 0)));
    }
  }
  return found;
}

export const anglesOf = (machine: Machine) => new Map(machine.joints.map((joint) => [joint.name, joint.position]));
