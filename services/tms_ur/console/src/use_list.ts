// A list of the server's: read at the start, and again when a run begins or ends, the connection comes back, or it failed.
import { useCallback, useEffect, useState } from "react";
import { listsChanged, subscribe } from "./live";

const RETRY = 5000; // ms until what could not be read is tried again

interface Found<T> {
  list: T | null; // null: not read yet
  error: Error | null; // why the last attempt failed; the list stays
  again: () => void;
}

/** `read` must not change from one drawing to the next. */
export function useList<T>(read: () => Promise<T>): Found<T> {
  const [list, setList] = useState<T | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const again = useCallback(() => {
    read().then(
      (found) => {
        setList(found);
        setError(null);
      },
      (why: Error) => setError(why),
    );
  }, [read]);
  useEffect(() => {
    if (error !== null) {
      const timer = setTimeout(again, RETRY); // the module that was away may be back
      return () => clearTimeout(timer);
    }
  }, [error, again]);
  useEffect(() => {
    again();
    return subscribe((now, before) => {
      if (listsChanged(now, before)) {
        again();
      }
    });
  }, [again]);
  return { list, error, again };
}
