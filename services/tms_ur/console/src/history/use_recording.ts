// Reads the recording of a run, again and again while the run goes on.
import { useEffect, useState } from "react";
import type { Recording } from "../models";
import { get } from "../server";

const POINTS = 1500; // of a series: more than a plot has pixels
const EVERY = 10_000; // ms; the recorder stores as often

/** null until it is read. */
export function useRecording(id: string, live: boolean): { recording: Recording | null; error: Error | null } {
  const [recording, setRecording] = useState<Recording | null>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    let [timer, left] = [0, false];
    const look = async () => {
      try {
        const found = await get("/api/recordings", {}, `run_id=${encodeURIComponent(id)}&points=${POINTS}`);
        if (!left) {
          setRecording(found);
          setError(null);
        }
      } catch (why) {
        if (!left) {
          setError(why as Error);
        }
      }
      if (live && !left) {
        timer = window.setTimeout(look, EVERY);
      }
    };
    look();
    return () => {
      left = true;
      clearTimeout(timer);
    };
  }, [id, live]);
  return { recording, error };
}
