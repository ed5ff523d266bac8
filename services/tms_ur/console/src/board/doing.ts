// What a machine does, from the running leaves of its run's tree.
import type { ActiveRun, Tree } from "../models";

const RUNNING = "1"; // digit of a node's state

export interface Doing {
  subtask: string;
  record: string;
}

const port = (ports: string, name: string) => new RegExp(`\\b${name}="([^"]*)"`).exec(ports)?.[1] ?? "";

/** The running leaves that name this machine; the shape of the tree may not be there yet. */
export function doingOf(machine: string, run: ActiveRun, tree: Tree | null): Doing[] {
  return (tree?.ports ?? [])
    .filter((ports, index) => run.nodes[index] === RUNNING && port(ports, "model_name") === machine)
    .map((ports) => ({ subtask: port(ports, "subtask_name"), record: port(ports, "record_name") }))
    .filter((one) => one.subtask !== "");
}
