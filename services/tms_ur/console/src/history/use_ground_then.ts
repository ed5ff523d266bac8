// The ground at the cursor: the last one that the database had kept until then.
import { useEffect, useRef, useState } from "react";
import type { Ground, ReasonView } from "../models";
import { get } from "../server";

const AGAIN = 600_000; // ms of the cursor after which the newest ground, or one that could not be read, is asked for anew

/** A ground, and the times [ms since the epoch] of the cursor that it is true for. */
export interface Kept {
  ground: Ground | null; // null: it could not be read
  error: Error | null; // why not
  from: number;
  to: number;
}

/** null until it is read. */
export function useGroundThen(time: number, shown: boolean): Kept | null {
  const [kept, setKept] = useState<Kept | null>(null);
  const asking = useRef(false);
  const there = kept !== null && kept.from <= time && time < kept.to;
  useEffect(() => {
    if (!shown || there || asking.current) {
      return; // one question at a time, however fast the cursor moves
    }
    asking.current = true;
    keptAt(time).then((found) => {
      asking.current = false;
      setKept(found);
    });
  }, [time, shown, there]);
  return kept;
}

async function keptAt(time: number): Promise<Kept> {
  const asked = `at=${encodeURIComponent(new Date(time).toISOString())}`;
  try {
    return keptFor(await get("/api/ground", {}, asked), time);
  } catch (why) {
    const { reason } = why as { reason?: ReasonView };
    return reason?.code === "GROUND_NOT_THERE" ? before(time) : unread(time, why as Error);
  }
}

/** For which times an answer is true. */
export function keptFor(ground: Ground, time: number): Kept {
  const from = ground.taken_at ? Date.parse(ground.taken_at) : Number.NEGATIVE_INFINITY;
  return { ground, error: null, from, to: ground.next_at ? Date.parse(ground.next_at) : time + AGAIN };
}

/** Nothing was kept until then: the ground of now is the best that is known. */
async function before(time: number): Promise<Kept> {
  return get("/api/ground").then(
    (ground) => ({ ground, error: null, from: Number.NEGATIVE_INFINITY, to: time + 1 }),
    (why: Error) => unread(time, why),
  );
}

const unread = (time: number, error: Error): Kept => ({ ground: null, error, from: time, to: time + AGAIN });
