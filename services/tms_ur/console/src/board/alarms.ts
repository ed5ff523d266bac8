// What is wrong beside the machines: the scheduler, PCs, and processes that cannot be kept up.
import type { State } from "../models";

const HOST_SILENT = 6; // s, as the server judges (board.py)
const GIVEN_UP = new Set(["FATAL", "BACKOFF"]); // states of supervisord

export interface Alarm {
  key: string;
  text: string; // its key among the texts
  values: Record<string, string>;
}

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
    for (const process of host.processes.filter((one) => GIVEN_UP.has(one.state))) {
      found.push({ key: process.name, text: "process_down", values: { name: process.name } });
    }
  }
  return found;
}
