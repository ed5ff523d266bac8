// Areas, people and vehicles on the map. Nothing of this protects anybody.
import { draw } from "./dom.js";
import { ask } from "./server.js";

let areas = [];

export async function loadAreas() {
  areas = (await ask("/api/areas")).areas.features ?? [];
}

/** Corners of all areas, in the order in which they are drawn: those where machines may be first. */
export function areaMarks() {
  const order = [...areas].sort((one, other) => (other.properties.type === "unmanned") - (one.properties.type === "unmanned"));
  return order.map((area) => draw("polygon", { class: `area ${area.properties.type}`, "data-area": area.properties.id,
    points: area.geometry.coordinates[0].map(([x, y]) => `${x},${-y}`).join(" ") }, draw("title", {}, area.properties.id)));
}

/** Where trackers see somebody; of a silent tracker, where somebody was. */
export const spots = (state) => state.seen.flatMap((one) => one.places.map((place) => ({ ...place, ...one })));

export function spotMark(spot) {
  return draw("circle", { class: `seen ${spot.kind}${spot.silent ? " silent" : ""}`, "data-tracker": spot.tracker,
    cx: spot.x, cy: -spot.y, r: spot.kind === "vehicle" ? 1.5 : 0.6 }, draw("title", {}, spot.tracker));
}
