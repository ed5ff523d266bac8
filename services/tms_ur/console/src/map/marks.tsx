// Areas, people and vehicles, records and paths on the map. Nothing of this protects anybody.

import { useTranslation } from "react-i18next";
import type { Machine, SeenBy, SharedPlace } from "../models";
import { type Area, drawn, middle, placeOf } from "./areas";
import type { PlaceRecord } from "./goals";
import { type Flat, svgPoints } from "./outline";
import { gridStep, type Size, type View } from "./view";

export function Grid({ view, size }: { view: View; size: Size }) {
  const step = gridStep(view.scale);
  const [w, h] = [size.width / view.scale / 2, size.height / view.scale / 2];
  const between = (low: number, high: number) => {
    const first = Math.ceil(low / step);
    return Array.from({ length: Math.max(0, Math.floor(high / step) - first + 1) }, (_, i) => (first + i) * step);
  };
  return (
    <>
      {between(view.x - w, view.x + w).map((x) => (
        <path key={`x${x}`} className={x === 0 ? "axis" : "grid"} d={`M${x} ${-view.y - h} V${-view.y + h}`} />
      ))}
      {between(view.y - h, view.y + h).map((y) => (
        <path key={`y${y}`} className={y === 0 ? "axis" : "grid"} d={`M${view.x - w} ${-y} H${view.x + w}`} />
      ))}
    </>
  );
}

export function AreaMarks({ areas, places, letters }: { areas: Area[]; places: SharedPlace[]; letters: number }) {
  const { t } = useTranslation();
  return drawn(areas).map((area) => {
    const place = placeOf(area, places);
    const [x, y] = middle(area.corners);
    const holder = place ? `: ${place.holder || t(`place_${place.state}`)}` : "";
    return (
      <g key={area.id}>
        <polygon className={`area ${area.type}`} data-area={area.id} points={svgPoints(area.corners)}>
          <title>{area.name || area.id}</title>
        </polygon>
        <text className="area_name" x={x} y={-y} fontSize={letters * 0.85} textAnchor="middle">
          {area.id}
          {holder}
        </text>
      </g>
    );
  });
}

/** Where trackers see somebody; of a silent tracker, where somebody was. */
export function SpotMarks({ seen }: { seen: SeenBy[] }) {
  return seen.flatMap((one) =>
    one.places.map(({ x, y }) => (
      <circle
        key={`${one.tracker} ${x} ${y}`}
        className={`seen ${one.kind}${one.silent ? " silent" : ""}`}
        data-tracker={one.tracker}
        cx={x}
        cy={-y}
        r={one.kind === "vehicle" ? 1.5 : 0.6}
      >
        <title>{one.tracker}</title>
      </circle>
    )),
  );
}

/** Places of records, small ones but for those that a machine goes to now, and the path through them. */
export function RecordMarks({ records, letters }: { records: PlaceRecord[]; letters: number }) {
  return records.map((one) => (
    <g key={`${one.model}/${one.record}`} className={one.goal ? "goal" : "spot"} data-record={one.record}>
      {one.points.length > 1 && <polyline points={svgPoints(one.points)} />}
      {one.points.map(([x, y], index) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: a path may pass a place twice
        <g key={index} transform={`translate(${x} ${-y})`}>
          <circle r={letters * (one.goal ? 0.3 : 0.18)} />
          <text x={letters * 0.4} y={letters * 0.3} fontSize={letters * 0.75}>
            {index === 0 ? one.record : index + 1}
          </text>
        </g>
      ))}
    </g>
  ));
}

/** The ways that machines drive now. */
export const WayMarks = ({ machines }: { machines: readonly Machine[] }) =>
  machines.map(
    ({ name, way = [] }) =>
      way.length > 1 && <polyline key={name} className="way" data-machine={name} points={svgPoints(way)} />,
  );

export const TrailMarks = ({ trails }: { trails: ReadonlyMap<string, Flat[]> }) =>
  [...trails].map(([name, points]) => <polyline key={name} className="trail" points={svgPoints(points)} />);
