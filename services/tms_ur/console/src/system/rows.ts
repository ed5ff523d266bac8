// The processes of the site in the order in which one looks for trouble.
import { isDown, type Process } from "../board/alarms";
import type { State } from "../models";

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
