// The view of a picture on the page, which people move.

import { type RefObject, useEffect, useLayoutEffect, useRef, useState } from "react";
import { Hands } from "./hands";
import type { Flat } from "./outline";
import { dragged, fitted, placeAt, type Size, type View, zoomed } from "./view";

export interface Viewing {
  view: View | null; // null: nothing is known that could be shown
  size: Size;
  zoom: (factor: number) => void;
  fit: () => void;
}

/** `all`: what is to be seen at first; `follow`: what stays in the middle; `onPlace`: a click on the map. */
export function useView(
  box: RefObject<HTMLElement | null>,
  all: readonly Flat[],
  follow: Flat | undefined,
  onMove: () => void,
  onPlace: (place: Flat) => void,
): Viewing {
  const [size, setSize] = useState<Size>({ width: 0, height: 0 });
  const [own, setOwn] = useState<View | null>(null);
  const first = own ?? (all.length > 0 && size.width > 0 ? fitted(all, size) : null);
  const view = first && follow ? { ...first, x: follow[0], y: follow[1] } : first;
  const from = (before: View | null) => (follow ? view : (before ?? view)); // several moves may come before a drawing
  const zoom = (factor: number, px = size.width / 2, py = size.height / 2) =>
    setOwn((before) => from(before) && zoomed(from(before) as View, size, factor, px, py));
  const move = (dx: number, dy: number) => {
    onMove();
    setOwn((before) => from(before) && dragged(from(before) as View, dx, dy));
  };
  const tap = (px: number, py: number) => view && onPlace(placeAt(view, size, px, py));
  const now = useRef({ zoom, move, tap });
  now.current = { zoom, move, tap };
  useEffect(() => {
    if (own === null && view !== null) {
      setOwn(view); // what was shown first stays
    }
  }, [own, view]);
  useLayoutEffect(() => {
    const element = box.current;
    if (element === null) {
      return;
    }
    const sized = new ResizeObserver(() => setSize({ width: element.clientWidth, height: element.clientHeight }));
    sized.observe(element);
    return () => sized.disconnect();
  }, [box]);
  useEffect(() => (box.current ? new Hands(box.current, () => now.current).end : undefined), [box]);
  return { view, size, zoom, fit: () => setOwn(fitted(all, size)) };
}
