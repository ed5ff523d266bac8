// A machine in 3D: its links in the mesh of all machines, which follow its joints.

import { type BatchedMesh, Color, Matrix4 } from "three";
import type { Machine, SiteMachine } from "../../models";
import { isOld } from "../old_place";
import { type Frame, links, placed } from "../pose";
import { eased, type Shown, told } from "./ease";

const STATES: Record<string, number> = { moving: 0xffd9b0, silent: 0x9aa2aa };
const USUAL = 0xffffff;
const LAMPS: Record<string, number> = { automatic: 0x00a843, manual: 0xffb000, stopped: 0xb00020, fault: 0x9aa2aa };
const ABOVE = 4.2; // m, of the lamp above the ground

export class Model {
  shown: Shown | null = null;
  private target: Shown | null = null;
  private readonly matrix = new Matrix4();
  private readonly colour = new Color();

  /** `parts`: the number of each link in the mesh. */
  constructor(
    private readonly body: SiteMachine,
    private readonly mesh: BatchedMesh,
    private readonly parts: ReadonlyMap<string, number>,
    private readonly lamp: number,
  ) {
    this.show(false);
  }

  /** Takes what the machine tells. */
  tell(machine: Machine) {
    this.target = told(machine);
    this.shown ??= this.target;
    this.show(this.shown !== null);
    this.colour.set(STATES[isOld(machine) ? "silent" : machine.state] ?? USUAL);
    for (const number of this.parts.values()) {
      this.mesh.setColorAt(number, this.colour);
    }
    this.mesh.setColorAt(this.lamp, this.colour.set(LAMPS[machine.lamp ?? "fault"] ?? USUAL));
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
    for (const [link, number] of this.parts) {
      this.put(number, frames.get(link) ?? placed(0, 0, 0));
    }
    this.put(this.lamp, placed(shown.x, shown.y, 0, z + ABOVE));
    return moves;
  }

  private put(number: number, frame: Frame) {
    const [a = 1, b = 0, c = 0, x = 0, d = 0, e = 1, f = 0, y = 0, g = 0, h = 0, i = 1, z = 0] = frame;
    this.mesh.setMatrixAt(number, this.matrix.set(a, b, c, x, d, e, f, y, g, h, i, z, 0, 0, 0, 1));
  }

  private show(visible: boolean) {
    for (const number of [...this.parts.values(), this.lamp]) {
      this.mesh.setVisibleAt(number, visible);
    }
  }
}
