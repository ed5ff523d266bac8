// Reads the recording of a run, again and again while the run goes on.
import { useEffect, useState } from "react";
import type { Recording } from "../models";
import { repeated } from "../repeated";
import { get } from "../server";

const POINTS = 1500; // of a series: more than a plot has pixels
const EVERY = 10_000; // ms; the recorder stores as often

/** null until it is read. */
export function useRecording(id: string, live: boolean): { recording: Recording | null; error: Error | null } {
  const [recording, setRecording] = useState<Recording | null>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    const took = (found: Recording) => {
      setRecording(found);
      setError(null);
    };
    const asked = `run_id=${encodeURIComponent(id)}&points=${POINTS}`;
    return repeated(() => get("/api/recordings", {}, asked), took, setError, live ? EVERY : null);
  }, [id, live]);
  return { recording, error };
}
