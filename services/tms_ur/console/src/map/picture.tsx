// The map from above.

import { useTranslation } from "react-i18next";
import type { SiteMachine, State } from "../models";
import type { Area } from "./areas";
import type { PlaceRecord } from "./goals";
import { MachineMark } from "./machine_mark";
import { AreaMarks, Grid, RecordMarks, SpotMarks, TrailMarks } from "./marks";
import type { Flat } from "./outline";
import { type Size, type View, viewBox } from "./view";

const LETTERS = 14; // px

export interface Scene {
  state: State;
  bodies: ReadonlyMap<string, SiteMachine>;
  areas: Area[];
  records: PlaceRecord[];
  trails: ReadonlyMap<string, Flat[]>;
}

export function Picture({ scene, view, size }: { scene: Scene; view: View; size: Size }) {
  const { t } = useTranslation();
  const { state, bodies } = scene;
  const letters = LETTERS / view.scale;
  const placed = state.machines.flatMap(({ name, place }) => (place ? [`${name} (${place.x}, ${place.y})`] : []));
  return (
    <svg id="site_map" role="img" viewBox={viewBox(view, size)} aria-label={`${t("map")}: ${placed.join("; ")}`}>
      <AreaMarks areas={scene.areas} places={state.shared?.places ?? []} letters={letters} />
      <Grid view={view} size={size} />
      <TrailMarks trails={scene.trails} />
      <RecordMarks records={scene.records} letters={letters} />
      <SpotMarks seen={state.seen ?? []} />
      {state.machines.map((machine) => {
        const body = bodies.get(machine.name);
        return body && <MachineMark key={machine.name} machine={machine} body={body} letters={letters} />;
      })}
    </svg>
  );
}
