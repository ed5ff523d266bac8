// Asks the server for something now, and again and again until nobody wants it any more.

/** `every`: ms from an answer to the next question; null: it is asked once. Returns what ends it. */
export function repeated<T>(
  read: (left: () => boolean) => Promise<T>,
  took: (found: T) => void,
  failed: (why: Error) => void,
  every: number | null,
): () => void {
  let [timer, left] = [0, false];
  const look = async () => {
    const act = await read(() => left).then(
      (found) => () => took(found),
      (why: Error) => () => failed(why),
    );
    if (left) {
      return;
    }
    act();
    if (every !== null) {
      timer = window.setTimeout(look, every);
    }
  };
  look();
  return () => {
    left = true;
    clearTimeout(timer);
  };
}
