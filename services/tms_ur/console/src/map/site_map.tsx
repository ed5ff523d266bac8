// The map, from above or in 3D, and what is chosen about it.

import { lazy, Suspense, useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { SiteMachine, State } from "../models";
import { Problem } from "../problem";
import { may } from "../role";
import { get } from "../server";
import { useList } from "../use_list";
import { clicked, type Draft, draftOf } from "./area_draft";
import { AreaEditor } from "./area_editor";
import { areasOf } from "./areas";
import { placesOf } from "./goals";
import { ZOOM } from "./hands";
import type { Flat } from "./outline";
import { Picture, type Scene } from "./picture";
import { PlaceForm } from "./place_form";
import { trailsOf } from "./trails";
import { useGround } from "./use_ground";
import { useView } from "./use_view";
import { fitted, gridStep } from "./view";

const REACH = 14; // px within which a click means a corner
const TYPICAL = { width: 1280, height: 720 }; // px, where the map from above has not been shown yet
const Space = lazy(() => import("./space/space"));

const readAreas = () => get("/api/areas");
const readRecords = () => get("/api/parameters");

interface Props {
  state: State;
  bodies: ReadonlyMap<string, SiteMachine>;
  inSpace: boolean;
  picking?: { machine: string; onSaved: (name: string) => void }; // a place for a record of this machine is wanted
}

export function SiteMap({ state, bodies, inSpace, picking }: Props) {
  const { t } = useTranslation();
  const { list: enabled, error, again: readAgain } = useList(readAreas);
  const [draft, setDraft] = useState<Draft | null>(null);
  const { list: records, error: noRecords, again } = useList(readRecords);
  const [chosen, setChosen] = useState<Flat | null>(null);
  const [follow, setFollow] = useState("");
  const [all, setAll] = useState(false);
  const [design, setDesign] = useState(false);
  const box = useRef<HTMLElement>(null);
  const areas = useMemo(() => areasOf(enabled), [enabled]);
  const scene = useMemo((): Scene => {
    const places = placesOf(records ?? [], state.runs).filter((one) => all || one.goal);
    return { state, bodies, areas, records: places, trails: trailsOf(state.machines) };
  }, [state, bodies, areas, records, all]);
  const { ground, error: noGround } = useGround(inSpace);
  const place = state.machines.find((one) => one.name === follow)?.place;
  // nothing is fitted before the areas are known: the view is not to jump when they come
  const known = enabled !== null || error !== null;
  const { view, size, zoom, fit } = useView(
    box,
    known ? outermost(scene) : [],
    place ? [place.x, place.y] : undefined,
    () => setFollow(""),
    (at, scale) => (draft ? setDraft(clicked(draft, at, REACH / scale)) : may("admin") && setChosen(at)),
  );
  const draw = () => {
    setChosen(null);
    setDraft(draftOf(areas));
  };
  const eye = view ?? (known ? fitted(outermost(scene), TYPICAL) : null);
  return (
    <>
      <section className="bar" aria-label={t("map_view")}>
        {!picking && (
          <a className="button" href={inSpace ? "#map" : "#map/3d"}>
            {t(inSpace ? "map_2d" : "map_3d")}
          </a>
        )}
        {!inSpace && <Zooms zoom={zoom} fit={fit} />}
        <label>
          {t("follow")}{" "}
          <select id="follow" value={follow} onChange={(event) => setFollow(event.target.value)}>
            <option value="">{t("follow_none")}</option>
            {state.machines.map((one) => (
              <option key={one.name}>{one.name}</option>
            ))}
          </select>
        </label>
        <Choice id="all_records" text={t("all_records")} chosen={all} choose={setAll} />
        {!inSpace && !picking && draft === null && (
          <button type="button" onClick={draw}>
            {t("change_areas")}
          </button>
        )}
        {inSpace && <Choice id="design" text={t("design_surface")} chosen={design} choose={setDesign} />}
      </section>
      <Problem id="areas_problem" what={t("areas")} error={error} />
      <Problem id="records_problem" what={t("p_data")} error={noRecords} />
      <Problem id="ground_problem" what={t("ground")} error={noGround} />
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: arrow keys move the map */}
      <section id="map_box" className="mapbox" hidden={inSpace} ref={box} tabIndex={0} aria-label={t("map_keys")}>
        {view && !inSpace && <Picture scene={scene} view={view} size={size} chosen={chosen} draft={draft} />}
      </section>
      {eye && inSpace && (
        <section id="space_box" className="mapbox" aria-label={t("map_3d")}>
          <Suspense>
            <Space scene={scene} view={eye} follow={follow} ground={ground} design={design} />
          </Suspense>
        </section>
      )}
      {draft && !inSpace && (
        <AreaEditor
          draft={draft}
          onChange={setDraft}
          onEnabled={() => {
            setDraft(null);
            readAgain();
          }}
          onClose={() => setDraft(null)}
        />
      )}
      {chosen && !inSpace && (
        <PlaceForm
          key={chosen.join()}
          place={chosen}
          machines={picking ? [picking.machine] : [...bodies.keys()]}
          records={records ?? []}
          areas={areas}
          onSaved={(name) => {
            setChosen(null);
            again();
            picking?.onSaved(name);
          }}
          onClose={() => setChosen(null)}
        />
      )}
      {view && !inSpace && <p className="small">{t("map_note", { step: gridStep(view.scale) })}</p>}
    </>
  );
}

export function Zooms({ zoom, fit }: { zoom: (factor: number) => void; fit: () => void }) {
  const { t } = useTranslation();
  return (
    <>
      <button type="button" aria-label={t("zoom_in")} onClick={() => zoom(ZOOM)}>
        +
      </button>
      <button type="button" aria-label={t("zoom_out")} onClick={() => zoom(1 / ZOOM)}>
        −
      </button>
      <button type="button" onClick={fit}>
        {t("show_all")}
      </button>
    </>
  );
}

interface ChoiceProps {
  id: string;
  text: string;
  chosen: boolean;
  choose: (chosen: boolean) => void;
}

function Choice({ id, text, chosen, choose }: ChoiceProps) {
  return (
    <label>
      <input id={id} type="checkbox" checked={chosen} onChange={(event) => choose(event.target.checked)} /> {text}
    </label>
  );
}

/** What is to be seen at first: all that stands still or moves, and the goals. */
function outermost({ state, areas, records }: Scene) {
  const places = state.machines.flatMap(({ place }) => (place ? [[place.x, place.y] as const] : []));
  const people = (state.seen ?? []).flatMap((one) => one.places.map(({ x, y }) => [x, y] as const));
  return [...places, ...people, ...areas.flatMap((one) => one.corners), ...records.flatMap((one) => one.points)];
}
