// The ground of now, read again and again while it is shown.
import { useEffect, useState } from "react";
import type { Ground } from "../models";
import { repeated } from "../repeated";
import { get } from "../server";

const EVERY = 10_000; // ms between two looks at the ground

interface Found {
  ground: Ground | null; // null: it was not read yet
  error: Error | null; // why the last look has failed; the ground stays as it was
}

export function useGround(shown: boolean): Found {
  const [found, setFound] = useState<Found>({ ground: null, error: null });
  useEffect(() => {
    if (!shown) {
      return;
    }
    const took = (ground: Ground) => setFound({ ground, error: null });
    return repeated(
      () => get("/api/ground"),
      took,
      (error) => setFound((before) => ({ ...before, error })),
      EVERY,
    );
  }, [shown]);
  return shown ? found : { ...found, error: null };
}
