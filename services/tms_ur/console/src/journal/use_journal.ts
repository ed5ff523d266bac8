// Reads the journal of a run, and what is added to it while it goes on.
import { useEffect, useMemo, useState } from "react";
import type { Event } from "../models";
import { repeated } from "../repeated";
import { get } from "../server";
import { type Journal, journalOf } from "./journal";

const PAGE = 1000; // events of one answer
export const MAX_EVENTS = 20_000; // events that a browser replays
const EVERY = 2000; // ms between looks for more

interface Found {
  id: string;
  events: Event[];
}

/** The known events and those that have come since; `left` tells that nobody waits any more. */
async function readMore({ id, events }: Found, left: () => boolean): Promise<Found> {
  const found = [...events];
  let page: Event[];
  do {
    page = await get("/api/runs/{run_id}/events", { run_id: id }, `after=${found.at(-1)?.number ?? 0}&limit=${PAGE}`);
    found.push(...page);
  } while (page.length === PAGE && found.length <= MAX_EVENTS && !left());
  return page.length === 0 && events.length === found.length ? { id, events } : { id, events: found };
}

/** null until it is read; an empty `id` asks for nothing. `live`: the run goes on. */
export function useJournal(id: string, live: boolean): { journal: Journal | null; error: Error | null } {
  const [found, setFound] = useState<Found>({ id: "", events: [] });
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    if (id === "") {
      return;
    }
    let known: Found = { id, events: [] };
    const read = async (left: () => boolean) => {
      known = await readMore(known, left);
      return known;
    };
    const took = (now: Found) => {
      setFound(now);
      setError(null);
    };
    return repeated(read, took, setError, live ? EVERY : null);
  }, [id, live]);
  const events = id !== "" && found.id === id ? found.events : null;
  const journal = useMemo(() => events && journalOf(events.slice(0, MAX_EVENTS), events.length > MAX_EVENTS), [events]);
  return { journal, error };
}
