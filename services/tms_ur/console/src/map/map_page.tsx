// Map: machines, areas, people, paths and records of the site, and the arms from the side.

import { useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useLive } from "../live";
import type { SiteMachine, State } from "../models";
import { get } from "../server";
import { useList } from "../use_list";
import { areasOf } from "./areas";
import { placesOf } from "./goals";
import { ZOOM } from "./hands";
import { Notes } from "./notes";
import { Picture, type Scene } from "./picture";
import { SideView } from "./side_view";
import { trailsOf } from "./trails";
import { useView } from "./use_view";
import { gridStep } from "./view";

const readSite = () => get("/api/site");
const readAreas = () => get("/api/areas");
const readRecords = () => get("/api/parameters");

export default function MapPage() {
  const { t } = useTranslation();
  const { state } = useLive();
  const site = useList(readSite).list;
  const bodies = useMemo(() => new Map(site?.machines.map((one) => [one.name, one])), [site]);
  return (
    <>
      <h2>{t("p_map")}</h2>
      {state && <Notes state={state} />}
      {state && site && <Map2D state={state} bodies={bodies} />}
      <div id="arms" className="cards">
        {state?.machines.map((machine) => {
          const body = bodies.get(machine.name);
          return body && body.arm.length > 1 && machine.joints.length > 0 ? (
            <SideView key={machine.name} machine={machine} body={body} />
          ) : null;
        })}
      </div>
    </>
  );
}

function Map2D({ state, bodies }: { state: State; bodies: ReadonlyMap<string, SiteMachine> }) {
  const { t } = useTranslation();
  const areas = useList(readAreas);
  const records = useList(readRecords);
  const [follow, setFollow] = useState("");
  const [all, setAll] = useState(false);
  const box = useRef<HTMLElement>(null);
  const shown = useMemo(() => areasOf(areas.list), [areas.list]);
  const places = placesOf(records.list ?? [], state.runs).filter((one) => all || one.goal);
  const scene: Scene = { state, bodies, areas: shown, records: places, trails: trailsOf(state.machines) };
  const place = state.machines.find((one) => one.name === follow)?.place;
  // nothing is fitted before the areas are known: the view is not to jump when they come
  const viewing = useView(
    box,
    areas.list || areas.error ? outermost(scene) : [],
    place ? [place.x, place.y] : undefined,
    () => setFollow(""),
    () => {},
  );
  const { view, size, zoom, fit } = viewing;
  return (
    <>
      <section className="bar" aria-label={t("map_view")}>
        <button type="button" aria-label={t("zoom_in")} onClick={() => zoom(ZOOM)}>
          +
        </button>
        <button type="button" aria-label={t("zoom_out")} onClick={() => zoom(1 / ZOOM)}>
          −
        </button>
        <button type="button" onClick={fit}>
          {t("show_all")}
        </button>
        <label>
          {t("follow")}{" "}
          <select id="follow" value={follow} onChange={(event) => setFollow(event.target.value)}>
            <option value="">{t("follow_none")}</option>
            {state.machines.map((one) => (
              <option key={one.name}>{one.name}</option>
            ))}
          </select>
        </label>
        <label>
          <input id="all_records" type="checkbox" checked={all} onChange={(event) => setAll(event.target.checked)} />{" "}
          {t("all_records")}
        </label>
      </section>
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: arrow keys move the map */}
      <section id="map_box" className="mapbox" ref={box} tabIndex={0} aria-label={t("map_keys")}>
        {view && <Picture scene={scene} view={view} size={size} />}
      </section>
      {view && <p className="small">{t("map_note", { step: gridStep(view.scale) })}</p>}
    </>
  );
}

/** What is to be seen at first: all that stands still or moves, and the goals. */
function outermost({ state, areas, records }: Scene) {
  const places = state.machines.flatMap(({ place }) => (place ? [[place.x, place.y] as const] : []));
  const people = (state.seen ?? []).flatMap((one) => one.places.map(({ x, y }) => [x, y] as const));
  return [...places, ...people, ...areas.flatMap((one) => one.corners), ...records.flatMap((one) => one.points)];
}
