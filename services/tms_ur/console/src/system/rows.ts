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

/** Those that hold `words` in their name or PC; what is down first, then essential ones, then those on demand. */
export function rowsOf(state: State, words: string): Row[] {
  const rank = ({ process }: Row) => (isDown(process) ? 0 : process.on_demand ? 2 : 1);
  return state.hosts
    .flatMap((host) => host.processes.map((process) => ({ host: host.name, process })))
    .filter(({ host, process }) => `${process.name} ${host}`.toLowerCase().includes(words.toLowerCase()))
    .map((row, index) => ({ row, index }))
    .sort((one, other) => rank(one.row) - rank(other.row) || one.index - other.index)
    .map(({ row }) => row);
}
