// Where the machines were at the cursor: the map from above, or 3D.
import { lazy, Suspense, useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { areasOf } from "../map/areas";
import { Picture, type Scene } from "../map/picture";
import { Zooms } from "../map/site_map";
import { useView } from "../map/use_view";
import { fitted } from "../map/view";
import type { Recording, State } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { dateTime } from "../texts";
import { useList } from "../use_list";
import { machinesAt, trailsAt, wayOf } from "./recording";
import { type Kept, useGroundThen } from "./use_ground_then";

const Space = lazy(() => import("../map/space/space"));
const TYPICAL = { width: 1280, height: 500 }; // px, where the map from above has not been shown yet

const readSite = () => get("/api/site");
const readAreas = () => get("/api/areas");
const nothing = () => {};

interface Props {
  recording: Recording;
  seconds: number; // since the epoch
}

export function PastMap({ recording, seconds }: Props) {
  const { t } = useTranslation();
  const [inSpace, setInSpace] = useState(false);
  const { list: site, error: noSite } = useList(readSite);
  const { list: enabled, error: noAreas } = useList(readAreas);
  const box = useRef<HTMLElement>(null);
  const ways = useMemo(
    () => recording.series.filter((one) => one.kind === "pose").flatMap((one) => wayOf(one)),
    [recording],
  );
  const scene = useMemo((): Scene => {
    const state = { machines: machinesAt(recording, seconds), seen: [] } as unknown as State; // nothing else is drawn
    const bodies = new Map(site?.machines.map((one) => [one.name, one]));
    return { state, bodies, areas: areasOf(enabled), records: [], trails: trailsAt(recording, seconds) };
  }, [recording, seconds, site, enabled]);
  const kept = useGroundThen(seconds * 1000, inSpace);
  const { view, size, zoom, fit } = useView(box, ways, undefined, nothing, nothing);
  if (ways.length === 0) {
    return null;
  }
  return (
    <>
      <div className="bar">
        <button type="button" id="past_3d" aria-pressed={inSpace} onClick={() => setInSpace(!inSpace)}>
          {t(inSpace ? "map_2d" : "map_3d")}
        </button>
        {!inSpace && <Zooms zoom={zoom} fit={fit} />}
        {inSpace && kept && <GroundNote kept={kept} />}
      </div>
      <Problem id="past_site_problem" what={t("machines")} error={noSite} />
      <Problem id="past_areas_problem" what={t("areas")} error={noAreas} />
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: arrow keys move the map */}
      <section id="map_box" className="mapbox past" hidden={inSpace} ref={box} tabIndex={0} aria-label={t("map_keys")}>
        {view && !inSpace && <Picture scene={scene} view={view} size={size} chosen={null} draft={null} />}
      </section>
      {inSpace && site && (
        <section id="space_box" className="mapbox past" aria-label={t("map_3d")}>
          <Suspense>
            <Space
              scene={scene}
              view={view ?? fitted(ways, TYPICAL)}
              follow=""
              ground={kept?.ground ?? null}
              design={false}
            />
          </Suspense>
        </section>
      )}
    </>
  );
}

/** When the ground was as it is shown. */
function GroundNote({ kept: { ground, error } }: { kept: Kept }) {
  const { t } = useTranslation();
  if (ground !== null && (ground.rows ?? 0) === 0) {
    return null; // the site keeps none
  }
  if (error !== null) {
    return <Problem id="ground_note" what={t("ground_unread")} error={error} />;
  }
  const text = ground === null ? t("ground_unread") : t("ground_of_now");
  return (
    <span id="ground_note" className="small">
      {ground?.taken_at ? t("ground_of_then", { time: dateTime(ground.taken_at) }) : text}
    </span>
  );
}
