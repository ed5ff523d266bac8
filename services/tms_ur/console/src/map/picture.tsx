// The map from above.

import { useTranslation } from "react-i18next";
import type { SiteMachine, State } from "../models";
import type { Draft } from "./area_draft";
import type { Area } from "./areas";
import { DraftMarks } from "./draft_marks";
import type { PlaceRecord } from "./goals";
import { MachineMark } from "./machine_mark";
import { AreaMarks, Grid, RecordMarks, SpotMarks, TrailMarks, WayMarks } from "./marks";
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

interface Props {
  scene: Scene;
  view: View;
  size: Size;
  chosen: Flat | null; // a place that a person has clicked
  draft: Draft | null; // of the areas
}

export function Picture({ scene, view, size, chosen, draft }: Props) {
  const { t } = useTranslation();
  const { state, bodies } = scene;
  const letters = LETTERS / view.scale;
  const placed = state.machines.flatMap(({ name, place }) => (place ? [`${name} (${place.x}, ${place.y})`] : []));
  return (
    <svg id="site_map" role="img" viewBox={viewBox(view, size)} aria-label={`${t("map")}: ${placed.join("; ")}`}>
      {draft ? (
        <DraftMarks draft={draft} enabled={scene.areas} letters={letters} />
      ) : (
        <AreaMarks areas={scene.areas} places={state.shared?.places ?? []} letters={letters} />
      )}
      <Grid view={view} size={size} />
      <TrailMarks trails={scene.trails} />
      <WayMarks machines={state.machines} />
      <RecordMarks records={scene.records} letters={letters} />
      <SpotMarks seen={state.seen ?? []} />
      {state.machines.map((machine) => {
        const body = bodies.get(machine.name);
        return body && <MachineMark key={machine.name} machine={machine} body={body} letters={letters} />;
      })}
      {chosen && (
        <path
          className="chosen"
          transform={`translate(${chosen[0]} ${-chosen[1]}) scale(${letters})`}
          d="M-1 0 H1 M0 -1 V1"
        />
      )}
    </svg>
  );
}
