// The ground in 3D: tiles in levels of detail, and the design as a surface that one sees through.

import {
  BufferGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  type Vector3,
} from "three";
import type { Ground } from "../../models";
import { COARSEST, Field, strides, type Tile, trianglesOf } from "./field";
import { meshOf } from "./mesh";

const MOST = 12_000; // triangles of the ground: 1,000 take about 1 ms without graphics hardware
const MOST_DESIGN = 12_000;
const DESIGN = 0x3b82f6;

export class Terrain {
  readonly group = new Group();
  readonly field: Field;
  private readonly design: Field | null;
  private readonly tiles: Tile[];
  private readonly shown: (Mesh | undefined)[] = [];
  private strides: number[] = [];
  private readonly material = new MeshBasicMaterial({ vertexColors: true });
  private readonly surface = new Group();

  constructor(ground: Ground) {
    this.field = new Field(ground, ground.heights ?? []);
    this.design = ground.design?.length ? new Field(ground, ground.design) : null;
    this.tiles = this.field.tiles();
    this.group.add(this.surface);
    this.surface.visible = false;
  }

  /** Triangles that are drawn. */
  get triangles(): number {
    const all = [...this.group.children, ...(this.surface.visible ? this.surface.children : [])];
    return all.reduce((sum, one) => sum + (one instanceof Mesh ? (one.geometry.index?.count ?? 0) / 3 : 0), 0);
  }

  /** Draws what lies near to the eye in more detail; returns whether something has changed. */
  look(eye: Vector3): boolean {
    const wanted = strides(this.tiles, [eye.x, eye.y], eye.z - this.field.near(eye.x, eye.y), MOST);
    const changed = wanted.flatMap((stride, index) => (stride === this.strides[index] ? [] : [index]));
    for (const index of changed) {
      this.redraw(index, wanted[index] ?? COARSEST);
    }
    this.strides = wanted;
    return changed.length > 0;
  }

  /** Shows or hides the design. */
  showDesign(shown: boolean) {
    if (shown && this.design !== null && this.surface.children.length === 0) {
      const material = new MeshBasicMaterial({ color: DESIGN, opacity: 0.35, transparent: true, side: DoubleSide });
      const levels = [1, 2, 4, 8, COARSEST];
      const stride = levels.find((one) => trianglesOf(one) * this.tiles.length <= MOST_DESIGN) ?? COARSEST;
      for (const tile of this.tiles) {
        this.surface.add(new Mesh(geometry(this.design, null, tile, stride), material));
      }
    }
    this.surface.visible = shown;
  }

  dispose() {
    this.group.traverse((one) => one instanceof Mesh && one.geometry.dispose());
    this.material.dispose();
  }

  private redraw(index: number, stride: number) {
    const tile = this.tiles[index];
    const old = this.shown[index];
    if (old) {
      this.group.remove(old);
      old.geometry.dispose();
    }
    if (tile) {
      const mesh = new Mesh(geometry(this.field, this.design, tile, stride), this.material);
      this.shown[index] = mesh;
      this.group.add(mesh);
    }
  }
}

function geometry(field: Field, design: Field | null, tile: Tile, stride: number): BufferGeometry {
  const { positions, colours, triangles } = meshOf(field, design, tile, stride);
  const found = new BufferGeometry();
  found.setAttribute("position", new Float32BufferAttribute(positions, 3));
  found.setAttribute("color", new Float32BufferAttribute(colours, 3));
  found.setIndex(triangles);
  return found;
}
