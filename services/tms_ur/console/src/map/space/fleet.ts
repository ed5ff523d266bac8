// All machines as one mesh: without graphics hardware each mesh costs as much as hundreds of triangles.

import { BatchedMesh, type BufferGeometry, MeshBasicMaterial } from "three";
import type { SiteMachine } from "../../models";
import { prisms } from "../shapes";
import { Model } from "./model";
import { lamp, solid } from "./solid";

const LAMP = "lamp"; // beside the names of links

export class Fleet {
  readonly mesh: BatchedMesh;
  readonly models: ReadonlyMap<string, Model>;

  constructor(bodies: Iterable<SiteMachine>) {
    const machines = [...bodies].map((body) => ({ body, parts: partsOf(body) }));
    const shapes = new Map([[LAMP, lamp()]]);
    for (const { parts } of machines) {
      for (const { key, make } of parts) {
        shapes.set(key, shapes.get(key) ?? make());
      }
    }
    const corners = [...shapes.values()].reduce((sum, one) => sum + one.getAttribute("position").count, 0);
    const count = machines.reduce((sum, { parts }) => sum + parts.length + 1, 0);
    this.mesh = new BatchedMesh(count, corners, 0, new MeshBasicMaterial({ vertexColors: true }));
    this.mesh.frustumCulled = this.mesh.perObjectFrustumCulled = this.mesh.sortObjects = false;
    const known = new Map([...shapes].map(([key, shape]) => [key, this.mesh.addGeometry(shape)]));
    const placed = (key: string) => this.mesh.addInstance(known.get(key) ?? 0);
    this.models = new Map(
      machines.map(({ body, parts }) => {
        const links = new Map(parts.map(({ link, key }) => [link, placed(key)]));
        return [body.name, new Model(body, this.mesh, links, placed(LAMP))];
      }),
    );
  }

  dispose() {
    this.mesh.dispose();
  }
}

interface Part {
  link: string;
  key: string; // machines of a model share their shapes
  make: () => BufferGeometry;
}

function partsOf(body: SiteMachine): Part[] {
  const links = Map.groupBy(prisms(body), (one) => one.link);
  return [...links].map(([link, all]) => ({ link, key: `${body.model} ${link}`, make: () => solid(all) }));
}
