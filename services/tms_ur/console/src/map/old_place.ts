// Whether the place of a machine is still to be believed.

import type { Machine } from "../models";

const OLD = 5; // s without a position: the machine may have driven on

export const isOld = (machine: Machine) => (machine.place_age ?? 0) > OLD;
