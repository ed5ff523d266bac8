// What the server answers, asked again and again while it is shown.
import { useEffect, useState } from "react";
import { repeated } from "./repeated";

/** `ask`: another one begins anew, so wrap it in useCallback; `every`: ms, null: it is asked once. */
export function useRepeated<T>(ask: () => Promise<T>, every: number | null) {
  const [found, setFound] = useState<T | null>(null); // null: it was not read yet
  const [error, setError] = useState<Error | null>(null); // why the last look has failed; what was found stays
  useEffect(() => {
    const took = (answer: T) => {
      setFound(answer);
      setError(null);
    };
    return repeated(ask, took, setError, every);
  }, [ask, every]);
  return { found, error };
}
