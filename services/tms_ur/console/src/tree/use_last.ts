// What nodes were before a loop set them back.
import { useRef } from "react";
import { type NodeState, STATES } from "./shape";

/** The last state of each node that was not idle, by its index; of the tree of one run, while it is looked at. */
export function useLast(run: string, digits: string): Map<number, NodeState> {
  const last = useRef({ run, states: new Map<number, NodeState>() });
  if (last.current.run !== run) {
    last.current = { run, states: new Map() };
  }
  [...digits].forEach((digit, index) => {
    const state = STATES[Number(digit)] ?? "idle";
    if (state !== "idle") {
      last.current.states.set(index, state);
    }
  });
  return last.current.states;
}
