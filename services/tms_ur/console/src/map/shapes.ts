// Bodies of machines as prisms: the solids of the machine's file, for eyes only; nothing is decided by them.

import type { SiteMachine } from "../models";

type Solid = SiteMachine["solids"][number];
export type Role = Solid["role"];

/** An outline in the x-z plane of a link, the same from y0 to y1 [m]. */
export interface Prism {
  link: string;
  role: Role;
  outline: readonly (readonly [number, number])[];
  y0: number;
  y1: number;
}

export function prisms(machine: SiteMachine): Prism[] {
  return machine.solids.flatMap((one) => {
    const outline = one.outline.map(([x = 0, z = 0]) => [x, z] as const);
    return one.y.map(([y0 = 0, y1 = 0]) => ({ link: one.link, role: one.role, outline, y0, y1 }));
  });
}
