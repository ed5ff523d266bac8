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
