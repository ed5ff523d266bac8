// Areas while a person draws them: each step makes a new list, so that nothing that is enabled is ever touched.

import type { Area } from "./areas";
import type { Flat } from "./outline";

export const TYPES = ["unmanned", "restricted", "manned", "blocked", "release", "speed_limit"];
const SPEED = 1.0; // m/s, of a new speed limit
const DIGITS = 100; // of a metre

export interface Draft {
  areas: Area[];
  area: number; // that is changed now; -1: none
  corner: number; // of that area, which the next click moves; -1: none
}

export const draftOf = (areas: readonly Area[]): Draft => ({ areas: [...areas], area: -1, corner: -1 });

/** The draft with the chosen area changed. */
export function changed(draft: Draft, change: Partial<Area>): Draft {
  const old = draft.areas[draft.area];
  return old ? { ...draft, areas: draft.areas.with(draft.area, typed({ ...old, ...change })) } : draft;
}

/** Only a speed limit has a speed, and only a release area says what happens when it is lost. */
function typed({ maximum_speed, on_loss, ...area }: Area): Area {
  return {
    ...area,
    ...(area.type === "speed_limit" && { maximum_speed: maximum_speed ?? SPEED }),
    ...(area.type === "release" && on_loss !== undefined && { on_loss }),
  };
}

export function added(draft: Draft): Draft {
  const names = new Set(draft.areas.map((one) => one.id));
  let number = draft.areas.length + 1;
  while (names.has(`area_${number}`)) {
    number += 1;
  }
  const area: Area = { id: `area_${number}`, type: "unmanned", corners: [] };
  return { areas: [...draft.areas, area], area: draft.areas.length, corner: -1 };
}

export const removed = (draft: Draft): Draft => draftOf(draft.areas.toSpliced(draft.area, 1));

export function cornerRemoved(draft: Draft): Draft {
  const corners = draft.areas[draft.area]?.corners.toSpliced(draft.corner, 1);
  return corners ? { ...changed(draft, { corners }), corner: -1 } : draft;
}

export function cornerMoved(draft: Draft, corner: number, [x, y]: Flat): Draft {
  const corners = draft.areas[draft.area]?.corners.with(corner, [rounded(x), rounded(y)]);
  return corners ? changed(draft, { corners }) : draft;
}

/** A click: takes up a corner within `reach` [m], puts down one that was taken up, or makes a new one. */
export function clicked(draft: Draft, place: Flat, reach: number): Draft {
  const area = draft.areas[draft.area];
  if (!area) {
    return draft;
  }
  const near = area.corners.findIndex(([x, y]) => Math.hypot(x - place[0], y - place[1]) <= reach);
  if (near >= 0) {
    return { ...draft, corner: near === draft.corner ? -1 : near };
  }
  if (draft.corner >= 0) {
    return { ...cornerMoved(draft, draft.corner, place), corner: -1 };
  }
  const at = bestSide(area.corners, place);
  return changed(draft, { corners: area.corners.toSpliced(at, 0, [rounded(place[0]), rounded(place[1])]) });
}

const rounded = (metres: number) => Math.round(metres * DIGITS) / DIGITS;

/** Where a new corner goes: into the side that it makes least longer. */
function bestSide(corners: readonly Flat[], place: Flat): number {
  const away = (one: Flat, other: Flat) => Math.hypot(one[0] - other[0], one[1] - other[1]);
  if (corners.length < 3) {
    return corners.length;
  }
  const longer = corners.map((from, index) => {
    const to = corners[(index + 1) % corners.length] ?? from;
    return away(from, place) + away(place, to) - away(from, to);
  });
  return longer.indexOf(Math.min(...longer)) + 1;
}

/** The document that `tms areas import` and the API read. */
export function documentOf(areas: readonly Area[]) {
  const features = areas.map(({ corners, ...properties }) => ({
    type: "Feature",
    properties,
    geometry: { type: "Polygon", coordinates: [[...corners, ...corners.slice(0, 1)]] },
  }));
  return { type: "FeatureCollection", frame: "map", features };
}
