// Areas of the site as GeoJSON in the frame `map`.

import type { EnabledAreas, SharedPlace } from "../models";
import type { Flat } from "./outline";

export interface Area {
  id: string;
  type: string; // unmanned, restricted, manned, blocked, release or speed_limit
  name?: string;
  maximum_speed?: number; // m/s
  on_loss?: string;
  corners: Flat[]; // the first one is not repeated
}

interface Feature {
  properties: Omit<Area, "corners">;
  geometry: { coordinates: number[][][] };
}

/** The areas of a document that the server has checked. */
export function areasOf(enabled: EnabledAreas | null): Area[] {
  const features = (enabled?.areas.features ?? []) as Feature[];
  return features.map(({ properties, geometry }) => ({
    ...properties,
    corners: (geometry.coordinates[0] ?? []).slice(0, -1).map(([x = 0, y = 0]) => [x, y] as const),
  }));
}

/** In the order in which they are drawn: those where machines may be first. */
export const drawn = (areas: readonly Area[]) =>
  [...areas].sort((one, other) => Number(other.type === "unmanned") - Number(one.type === "unmanned"));

export const placeOf = (area: Area, places: readonly SharedPlace[]) => places.find((one) => one.name === area.id);

/** The middle of its corners: where its name stands. */
export function middle(corners: readonly Flat[]): Flat {
  const sum = corners.reduce(([a, b], [x, y]) => [a + x, b + y] as const, [0, 0] as Flat);
  return [sum[0] / (corners.length || 1), sum[1] / (corners.length || 1)];
}

/** Whether a place lies inside a polygon: a ray from it crosses the border an odd number of times. */
export function inside([x, y]: Flat, corners: readonly Flat[]): boolean {
  return corners.reduce((found, [ax, ay], index) => {
    const [bx, by] = corners[(index + 1) % corners.length] ?? [ax, ay];
    const crosses = ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax);
    return found !== crosses;
  }, false);
}

const FORBIDDEN = ["manned", "blocked"];

/** Why no machine may stand at a place: a key of the texts and its values; null: the areas allow it. */
export function flawOf(place: Flat, areas: readonly Area[]): [string, Record<string, string>] | null {
  const told = { x: place[0].toFixed(2), y: place[1].toFixed(2) };
  const forbidden = areas.find((one) => FORBIDDEN.includes(one.type) && inside(place, one.corners));
  if (forbidden) {
    return ["place_forbidden", { ...told, area: forbidden.id }];
  }
  const allowed = areas.filter((one) => one.type === "unmanned");
  const out = allowed.length > 0 && !allowed.some((one) => inside(place, one.corners));
  return out ? ["place_outside", told] : null;
}
