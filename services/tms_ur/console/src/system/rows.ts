// The processes of the site in the order in which one looks for trouble.
import type { Process, State } from "../models";

const UP = new Set(["RUNNING", "STARTING"]); // states of supervisord
const GIVEN_UP = new Set(["FATAL", "BACKOFF"]);

/** Whether a process that should run does not: an essential one always should, one on demand once it was asked for. */
export const isDown = ({ state, on_demand }: Process) =>
  state !== "UNKNOWN" && (on_demand ? GIVEN_UP.has(state) : !UP.has(state));

export interface Row {
  host: string;
  process: Process;
}

/** Those that hold `words` in their name or PC, essential ones apart from those on demand; what is down comes first. */
export function groupsOf(state: State, words: string): { essential: Row[]; onDemand: Row[] } {
  const found = state.hosts
    .flatMap((host) => host.processes.map((process) => ({ host: host.name, process })))
    .filter(({ host, process }) => `${process.name} ${host}`.toLowerCase().includes(words.toLowerCase()));
  const group = (on_demand: boolean) => downFirst(found.filter(({ process }) => process.on_demand === on_demand));
  return { essential: group(false), onDemand: group(true) };
}

const downFirst = (rows: Row[]) => [
  ...rows.filter(({ process }) => isDown(process)),
  ...rows.filter(({ process }) => !isDown(process)),
];
