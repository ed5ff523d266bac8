// Names of machines over the picture in 3D: elements of the page, so that they stay sharp and cost no drawing.

import { type PerspectiveCamera, Vector3 } from "three";
import type { Model } from "./model";

const ABOVE = 5; // m above the ground

export class Labels {
  private readonly shown = new Map<string, HTMLElement>();

  constructor(private readonly box: HTMLElement) {}

  place(
    models: ReadonlyMap<string, Model>,
    camera: PerspectiveCamera,
    { clientWidth, clientHeight }: HTMLCanvasElement,
    height: (x: number, y: number) => number,
  ) {
    for (const [name, { shown }] of models) {
      const label = this.of(name);
      const at = shown && new Vector3(shown.x, shown.y, height(shown.x, shown.y) + ABOVE).project(camera);
      label.hidden = !at || at.z > 1 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1;
      if (at && !label.hidden) {
        const [x, y] = [((at.x + 1) / 2) * clientWidth, ((1 - at.y) / 2) * clientHeight];
        label.style.transform = `translate(${x.toFixed(0)}px, ${y.toFixed(0)}px) translate(-50%, -100%)`;
      }
    }
  }

  private of(name: string): HTMLElement {
    let label = this.shown.get(name);
    if (label === undefined) {
      label = document.createElement("span");
      label.textContent = name;
      this.box.append(label);
      this.shown.set(name, label);
    }
    return label;
  }
}
