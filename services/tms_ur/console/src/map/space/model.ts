// A machine in 3D: the prisms of each of its links as one mesh, which follows its joints.

import {
  BufferGeometry,
  Color,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  OctahedronGeometry,
  ShapeUtils,
  Vector2,
  Vector3,
} from "three";
import type { Machine, SiteMachine } from "../../models";
import { isOld } from "../old_place";
import { links, placed } from "../pose";
import { type Prism, prisms, type Role } from "../shapes";
import { eased, type Shown, told } from "./ease";

const COLOURS: Record<Role, number> = { track: 0x3a4149, body: 0xffb000, arm: 0xffc94d, tool: 0x7a5418 };
const STATES: Record<string, number> = { moving: 0xffd9b0, silent: 0x9aa2aa };
const LAMPS: Record<string, number> = { automatic: 0x00a843, manual: 0xffb000, stopped: 0xb00020, fault: 0x9aa2aa };
const SUN = new Vector3(0.2, 0.5, 0.84); // in the frame of each link
const LAMP = 0.35; // m, radius
const ABOVE = 4.2; // m, of the lamp above the ground

export class Model {
  readonly group = new Group();
  shown: Shown | null = null;
  private target: Shown | null = null;
  private readonly material = new MeshBasicMaterial({ vertexColors: true });
  private readonly lamp = new Mesh(new OctahedronGeometry(LAMP), new MeshBasicMaterial());
  private readonly meshes = new Map<string, Mesh>();

  constructor(private readonly body: SiteMachine) {
    const parts = Map.groupBy(prisms(body), (one) => one.link);
    for (const [link, all] of parts) {
      const mesh = new Mesh(geometry(all), this.material);
      mesh.matrixAutoUpdate = false;
      this.meshes.set(link, mesh);
      this.group.add(mesh);
    }
    this.group.add(this.lamp);
    this.group.visible = false;
  }

  /** Takes what the machine tells. */
  tell(machine: Machine) {
    this.target = told(machine);
    this.shown ??= this.target;
    this.group.visible = this.shown !== null;
    this.material.color.set(STATES[isOld(machine) ? "silent" : machine.state] ?? 0xffffff);
    this.lamp.material.color.set(LAMPS[machine.lamp ?? "fault"] ?? 0x9aa2aa);
  }

  /** Moves on to what was told last, `seconds` after the picture before; whether it is still on its way. */
  move(seconds: number, height: (x: number, y: number) => number): boolean {
    if (this.shown === null || this.target === null) {
      return false;
    }
    const { shown, moves } = eased(this.shown, this.target, seconds);
    this.shown = shown;
    const z = height(shown.x, shown.y);
    const frames = links(this.body, shown.angles, placed(shown.x, shown.y, shown.yaw, z));
    for (const [link, mesh] of this.meshes) {
      const [a = 1, b = 0, c = 0, x = 0, d = 0, e = 1, f = 0, y = 0, g = 0, h = 0, i = 1, up = 0] =
        frames.get(link) ?? [];
      mesh.matrix.set(a, b, c, x, d, e, f, y, g, h, i, up, 0, 0, 0, 1);
      mesh.matrixWorldNeedsUpdate = true;
    }
    this.lamp.position.set(shown.x, shown.y, z + ABOVE);
    return moves;
  }
}

/** All prisms of a link; each side has one shade, so that no light has to be computed for each pixel. */
function geometry(all: readonly Prism[]): BufferGeometry {
  const [positions, colours]: [number[], number[]] = [[], []];
  for (const prism of all) {
    const corners = sides(prism);
    const colour = new Color(COLOURS[prism.role]);
    for (let i = 0; i < corners.length; i += 9) {
      const shade = shadeOf(corners.slice(i, i + 9));
      for (let corner = 0; corner < 3; corner += 1) {
        colours.push(colour.r * shade, colour.g * shade, colour.b * shade);
      }
    }
    positions.push(...corners);
  }
  const found = new BufferGeometry();
  found.setAttribute("position", new Float32BufferAttribute(positions, 3));
  found.setAttribute("color", new Float32BufferAttribute(colours, 3));
  return found;
}

/** Of a triangle: light from above, and somewhat from the left. */
function shadeOf([ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0, cx = 0, cy = 0, cz = 0]: number[]): number {
  const [a, b] = [new Vector3(bx - ax, by - ay, bz - az), new Vector3(cx - ax, cy - ay, cz - az)];
  return 0.7 + 0.3 * a.cross(b).normalize().dot(SUN);
}

/** Triangles of a prism, each with its corners anticlockwise from outside. */
function sides({ outline, y0, y1 }: Prism): number[] {
  const turns = ShapeUtils.isClockWise(outline.map(([x, z]) => new Vector2(x, z)));
  const points = turns ? [...outline].reverse() : [...outline];
  const flat = points.map(([x, z]) => new Vector2(x, z));
  const found: number[] = [];
  const put = (index: number, y: number) => {
    const [x = 0, z = 0] = points[index] ?? [];
    found.push(x, y, z);
  };
  for (const [a = 0, b = 0, c = 0] of ShapeUtils.triangulateShape(flat, [])) {
    for (const index of [a, b, c]) put(index, y0); // x-z plane: anticlockwise looks to -y
    for (const index of [c, b, a]) put(index, y1);
  }
  points.forEach((_, a) => {
    const b = (a + 1) % points.length;
    put(a, y0);
    put(a, y1);
    put(b, y1);
    put(a, y0);
    put(b, y1);
    put(b, y0);
  });
  return found;
}
