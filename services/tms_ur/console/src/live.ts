// The live state of the site and the connection to it, for all components.

import { watch } from "old/server.js";
import { useSyncExternalStore } from "react";
import type { State } from "./models";

export interface Live {
  state: State | null;
  link: boolean | null; // null: not known yet
}

let live: Live = { state: null, link: null };
const listeners = new Set<(now: Live, before: Live) => void>();

function put(changed: Partial<Live>) {
  const before = live;
  live = { ...live, ...changed };
  for (const listener of listeners) {
    listener(live, before);
  }
}

/** Connects; once, when somebody is logged in. */
export function connect() {
  watch(
    (state) => put({ state }),
    (link) => put({ link }),
  );
}

export function subscribe(listener: (now: Live, before: Live) => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export const current = () => live;

export const useLive = () => useSyncExternalStore(subscribe, current);

const runs = (state: State | null) => state?.runs.map((run) => `${run.run_id} ${run.state}`).join();

/** Whether lists are old: the connection has come back, or a run has begun or ended. */
export const listsChanged = (now: Live, before: Live) =>
  (now.link === true && before.link !== true) || (before.state !== null && runs(before.state) !== runs(now.state));

/** Runs that were active and are not any more. */
export const ended = (now: State | null, before: State | null) =>
  (before?.runs ?? []).filter((run) => !now?.runs.some((other) => other.run_id === run.run_id));
