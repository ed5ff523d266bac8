// What machines told while a run was active, at a moment of it and by time.
import type { Flat } from "../map/outline";
import type { Machine, Recording, Series } from "../models";
import type { Line } from "../plot";

const OVER = 1; // s over which a speed is worked out: a place is told in steps
const STILL = 0.05; // m; who has not moved farther has no speed to be shown

/** Index of the last time that is not after `seconds`; -1: there is none. */
export function indexAt(times: readonly number[], seconds: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? 0) <= seconds) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low - 1;
}

/** Its values by their names, and how old they were [s]; null: nothing was told until then. */
export function valuesAt(
  series: Series | undefined,
  seconds: number,
): { values: Map<string, number>; age: number } | null {
  const index = series === undefined ? -1 : indexAt(series.times, seconds);
  if (series === undefined || index < 0) {
    return null;
  }
  const values = new Map(series.names.map((name, column) => [name, series.values[column]?.[index] ?? 0]));
  return { values, age: seconds - (series.times[index] ?? 0) };
}

/** When it ends, ms; never, where there is none. */
export const recordedUntil = (recording: Recording | null) =>
  Math.max(...(recording?.series ?? []).map((one) => (one.times.at(-1) ?? 0) * 1000), Number.NEGATIVE_INFINITY);

export const machinesOf = ({ series }: Recording) => [...new Set(series.map((one) => one.machine))];

export const seriesOf = ({ series }: Recording, machine: string, kind: Series["kind"]) =>
  series.find((one) => one.machine === machine && one.kind === kind);

/** The machines as the map shows them; nobody has recorded their lamps. */
export function machinesAt(recording: Recording, seconds: number): Machine[] {
  return machinesOf(recording).map((name) => {
    const [pose, joints] = [
      valuesAt(seriesOf(recording, name, "pose"), seconds),
      valuesAt(seriesOf(recording, name, "joints"), seconds),
    ];
    const at = (key: string) => pose?.values.get(key) ?? 0;
    return {
      name,
      state: "standing",
      joints: [...(joints?.values ?? [])].map(([joint, position]) => ({ name: joint, position, velocity: 0 })),
      place: pose && { x: at("x"), y: at("y"), yaw: at("yaw") },
      place_age: pose?.age ?? null,
    } as Machine;
  });
}

/** Where machines have driven until then. */
export function trailsAt(recording: Recording, seconds: number): Map<string, Flat[]> {
  return new Map(machinesOf(recording).map((name) => [name, wayOf(seriesOf(recording, name, "pose"), seconds)]));
}

/** The whole way, or that until a time. */
export function wayOf(pose: Series | undefined, seconds = Number.POSITIVE_INFINITY): Flat[] {
  const [xs = [], ys = []] = pose?.values ?? [];
  return xs.slice(0, indexAt(pose?.times ?? [], seconds) + 1).map((x, index) => [x, ys[index] ?? 0] as const);
}

/** How fast the base moved [m/s], over a second each. */
export function speedsOf(pose: Series): number[] {
  const way = wayOf(pose);
  return pose.times.map((time, index) => {
    const before = Math.max(0, indexAt(pose.times, time - OVER));
    const [from, to] = [way[before], way[index]];
    const took = time - (pose.times[before] ?? time);
    return from && to && took > 0 ? Math.hypot(to[0] - from[0], to[1] - from[1]) / took : 0;
  });
}

export interface Drawn {
  title: "plot_joints" | "plot_speed" | "plot_load"; // key
  times: number[]; // s since the epoch
  lines: Line[];
}

/** The plots of a machine; what never changed by itself, as the speed of one that stood, has none. */
export function plotsOf(recording: Recording, machine: string): Drawn[] {
  const plots: Drawn[] = [];
  const [joints, pose, load] = (["joints", "pose", "load"] as const).map((kind) => seriesOf(recording, machine, kind));
  if (joints) {
    const lines = joints.names.map((name, column) => ({ name, values: joints.values[column] ?? [] }));
    plots.push({ title: "plot_joints", times: joints.times, lines });
  }
  if (pose && moved(wayOf(pose))) {
    plots.push({ title: "plot_speed", times: pose.times, lines: [{ name: machine, values: speedsOf(pose) }] });
  }
  const loose = load?.values[load.names.indexOf("loose")];
  if (load && loose?.some((one) => one > 0)) {
    plots.push({ title: "plot_load", times: load.times, lines: [{ name: machine, values: loose }] });
  }
  return plots;
}

const moved = (way: Flat[]) => way.some(([x, y]) => Math.hypot(x - (way[0]?.[0] ?? x), y - (way[0]?.[1] ?? y)) > STILL);
