// Prisms as triangles with a colour for each side.

import { BufferGeometry, Color, Float32BufferAttribute, OctahedronGeometry, ShapeUtils, Vector2, Vector3 } from "three";
import type { Prism, Role } from "../shapes";

const COLOURS: Record<Role, number> = { track: 0x3a4149, body: 0xffb000, arm: 0xffc94d, tool: 0x7a5418 };
const SUN = new Vector3(0.2, 0.5, 0.84); // in the frame of each link
const LAMP = 0.35; // m, radius

/** A lamp, white: it is coloured where it is shown. */
export function lamp(): BufferGeometry {
  const positions = [...new OctahedronGeometry(LAMP).getAttribute("position").array];
  return painted(
    positions,
    positions.map(() => 1),
  );
}

/** What all shapes of one mesh have, and nothing else. */
function painted(positions: number[], colours: number[]): BufferGeometry {
  const found = new BufferGeometry();
  found.setAttribute("position", new Float32BufferAttribute(positions, 3));
  found.setAttribute("color", new Float32BufferAttribute(colours, 3));
  return found;
}

/** All prisms of a link; each side has one shade, so that no light has to be computed for each pixel. */
export function solid(all: readonly Prism[]): BufferGeometry {
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
  return painted(positions, colours);
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
