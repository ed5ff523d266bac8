// One light for the whole site, from everything that is known of it.
import type { Machine, State } from "../models";

export type Light = "unknown" | "stopped" | "attention" | "moving" | "ready";

/** What the light is, and the machines that make it so. */
export interface Shown {
  light: Light;
  machines: string[];
}

const MARKS: Record<Light, string> = { unknown: "?", stopped: "⬣", attention: "▲", moving: "▶", ready: "●" };
export const markOf = (light: Light) => MARKS[light];

const waits = (machine: Machine) =>
  machine.state === "silent" ||
  machine.state === "not_ready" ||
  machine.hold !== null ||
  machine.by_hand !== "" ||
  machine.watched.people !== null;

/** `needed`: how many things beside the machines wait for a person. */
export function lightOf(state: State, link: boolean | null, needed: number): Shown {
  const named = (chosen: Machine[]) => chosen.map((machine) => machine.name);
  if (link !== true) {
    return { light: "unknown", machines: [] };
  }
  const stopped = state.machines.filter((machine) => machine.latch);
  if (stopped.length > 0) {
    return { light: "stopped", machines: named(stopped) };
  }
  const waiting = state.machines.filter(waits);
  if (waiting.length > 0 || needed > 0 || state.questions.length > 0 || !state.scheduler.alive) {
    return { light: "attention", machines: named(waiting) };
  }
  const moving = state.machines.filter((machine) => machine.state === "moving");
  return moving.length > 0 ? { light: "moving", machines: named(moving) } : { light: "ready", machines: [] };
}
