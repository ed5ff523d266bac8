// Reads the recording of a run, again and again while the run goes on.
import { useCallback } from "react";
import type { Recording } from "../models";
import { get } from "../server";
import { useRepeated } from "../use_repeated";

const POINTS = 1500; // of a series: more than a plot has pixels
const EVERY = 10_000; // ms; the recorder stores as often

/** null until it is read. */
export function useRecording(id: string, live: boolean): { recording: Recording | null; error: Error | null } {
  const asked = `run_id=${encodeURIComponent(id)}&points=${POINTS}`;
  const ask = useCallback(() => get("/api/recordings", {}, asked), [asked]);
  const { found, error } = useRepeated(ask, live ? EVERY : null);
  return { recording: found, error };
}
