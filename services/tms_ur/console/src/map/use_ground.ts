// The ground of now, read again and again while it is shown.
import { useEffect, useState } from "react";
import type { Ground } from "../models";
import { repeated } from "../repeated";
import { get } from "../server";

const EVERY = 10_000; // ms between two looks at the ground

/** null until it is read. */
export function useGround(shown: boolean): Ground | null {
  const [ground, setGround] = useState<Ground | null>(null);
  useEffect(() => {
    if (!shown) {
      return;
    }
    const failed = () => undefined; // it stays as it was; the next look may be luckier
    return repeated(() => get("/api/ground"), setGround, failed, EVERY);
  }, [shown]);
  return ground;
}
