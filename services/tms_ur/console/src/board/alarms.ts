// What is wrong beside the machines: the scheduler, PCs, and processes that should run, as Prometheus judges them
// (TmsProcessDown, TmsSubtaskDown).
import type { State } from "../models";

const HOST_SILENT = 6; // s, as the server judges (board.py)
const UP = new Set(["RUNNING", "STARTING"]); // states of supervisord
const GIVEN_UP = new Set(["FATAL", "BACKOFF"]);

export type Process = State["hosts"][number]["processes"][number];

export interface Alarm {
  key: string;
  text: string; // its key among the texts
  values: Record<string, string>;
}

/** Whether a process that should run does not: an essential one always should, one on demand once it was asked for. */
export const isDown = ({ state, on_demand }: Process) =>
  state !== "UNKNOWN" && (on_demand ? GIVEN_UP.has(state) : !UP.has(state));

export function alarmsOf(state: State): Alarm[] {
  const found: Alarm[] = [];
  if (!state.scheduler.alive) {
    found.push({ key: "scheduler", text: "scheduler_silent", values: {} });
  }
  for (const host of state.hosts) {
    if (host.age > HOST_SILENT) {
      found.push({ key: host.name, text: "host_silent", values: { name: host.name } });
      continue;
    }
    for (const process of host.processes.filter(isDown)) {
      found.push({ key: process.name, text: "process_down", values: { name: process.name } });
    }
  }
  return found;
}
