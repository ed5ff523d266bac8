// Areas, paths, records and people in 3D, laid on the ground.

import {
  BufferGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
} from "three";
import type { Flat } from "../outline";
import type { Scene } from "../picture";

const ABOVE = 0.25; // m above the ground, so that it is not hidden
const STEP = 2; // m between points that are laid on the ground
const AREAS: Record<string, number> = { unmanned: 0x0a7d33, restricted: 0xb58900, manned: 0xb00020, blocked: 0xb00020 };
const OTHER_AREA = 0x0a4fb3;
const [TRAIL, GOAL, PERSON, VEHICLE] = [0x3d4650, 0x0a4fb3, 0xd0102a, 0x6a1b9a];
const TALL = 1.8; // m

type Height = (x: number, y: number) => number;

/** Areas, paths and records. */
export function laid(scene: Scene, height: Height): Group {
  const group = new Group();
  for (const { type, corners } of scene.areas) {
    group.add(line([...corners, ...corners.slice(0, 1)], AREAS[type] ?? OTHER_AREA, height));
  }
  for (const trail of scene.trails.values()) {
    group.add(line(trail, TRAIL, height));
  }
  for (const { way = [] } of scene.state.machines) {
    group.add(line(way, GOAL, height));
  }
  for (const { points, goal } of scene.records) {
    group.add(line(points, GOAL, height));
    group.add(...points.map(([x, y]) => post(x, y, goal ? 0.3 : 0.15, GOAL, height)));
  }
  return group;
}

/** People and vehicles that trackers see. */
export function people(scene: Scene, height: Height): Group {
  const group = new Group();
  for (const one of scene.state.seen ?? []) {
    const [wide, colour] = one.kind === "vehicle" ? [1.2, VEHICLE] : [0.3, PERSON];
    group.add(...one.places.map(({ x, y }) => post(x, y, wide, colour, height)));
  }
  return group;
}

function post(x: number, y: number, wide: number, color: number, height: Height): Mesh {
  const mesh = new Mesh(new CylinderGeometry(wide, wide, TALL, 8), new MeshBasicMaterial({ color }));
  mesh.rotation.x = Math.PI / 2;
  mesh.position.set(x, y, height(x, y) + TALL / 2);
  return mesh;
}

function line(points: readonly Flat[], color: number, height: Height): Line {
  const places = draped(points).flatMap(([x, y]) => [x, y, height(x, y) + ABOVE]);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(places, 3));
  return new Line(geometry, new LineBasicMaterial({ color }));
}

/** The same way with points in between. */
export function draped(points: readonly Flat[]): Flat[] {
  return points.flatMap((to, index) => {
    const from = points[index - 1];
    if (from === undefined) {
      return [to];
    }
    const count = Math.max(1, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / STEP));
    const along = (part: number): Flat => [from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part];
    return Array.from({ length: count }, (_, i) => along((i + 1) / count));
  });
}

export function disposed(group: Group) {
  group.traverse((one) => {
    if (one instanceof Mesh || one instanceof Line) {
      one.geometry.dispose();
      one.material.dispose();
    }
  });
}
