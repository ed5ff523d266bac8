// Draws areas anew: as a draft of this browser, which can be checked, saved as a file, and enabled by a person.

import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { confirmed } from "../confirm";
import type { AreasChecked } from "../models";
import { Problem } from "../problem";
import { may } from "../role";
import { Said } from "../said";
import { post } from "../server";
import { said, texts } from "../texts";
import { added, changed, cornerMoved, cornerRemoved, type Draft, documentOf, removed, TYPES } from "./area_draft";
import type { Area } from "./areas";

interface Props {
  draft: Draft;
  onChange: (draft: Draft) => void;
  onEnabled: () => void;
  onClose: () => void;
}

export function AreaEditor({ draft, onChange, onEnabled, onClose }: Props) {
  const { t } = useTranslation();
  const area = draft.areas[draft.area];
  return (
    <section id="area_editor" className="card" aria-label={t("area_editor")}>
      <h3>{t("area_editor")}</h3>
      <p>{t("area_help")}</p>
      <div className="bar">
        <label>
          {t("area")}
          <select
            value={draft.area}
            onChange={(event) => onChange({ ...draft, area: Number(event.target.value), corner: -1 })}
          >
            <option value={-1}>-</option>
            {draft.areas.map((one, index) => (
              // biome-ignore lint/suspicious/noArrayIndexKey: two areas may be called the same while they are named
              <option key={index} value={index}>
                {one.id}
              </option>
            ))}
          </select>
        </label>
        <button type="button" onClick={() => onChange(added(draft))}>
          {t("new_area")}
        </button>
        {area && (
          <button type="button" onClick={() => onChange(removed(draft))}>
            {t("remove_area")}
          </button>
        )}
      </div>
      {area && <AreaFields area={area} draft={draft} onChange={onChange} />}
      <Verdict key={JSON.stringify(draft.areas)} areas={draft.areas} onEnabled={onEnabled} onClose={onClose} />
    </section>
  );
}

function AreaFields({ area, draft, onChange }: { area: Area; draft: Draft; onChange: (draft: Draft) => void }) {
  const { t } = useTranslation();
  const [x, y] = area.corners[draft.corner] ?? [];
  const move = (to: [number, number]) => to.every(Number.isFinite) && onChange(cornerMoved(draft, draft.corner, to));
  return (
    <div className="bar">
      <label>
        {t("area_id")}
        <input
          maxLength={64}
          value={area.id}
          onChange={(event) => onChange(changed(draft, { id: event.target.value }))}
        />
      </label>
      <label>
        {t("type")}
        <select value={area.type} onChange={(event) => onChange(changed(draft, { type: event.target.value }))}>
          {TYPES.map((type) => (
            <option key={type} value={type}>
              {t(`area_${type}`)}
            </option>
          ))}
        </select>
      </label>
      {area.type === "speed_limit" && (
        <label>
          {t("area_speed")}
          <input
            type="number"
            step="any"
            value={area.maximum_speed ?? ""}
            onChange={(event) => onChange(changed(draft, { maximum_speed: event.target.valueAsNumber }))}
          />
        </label>
      )}
      {x !== undefined && y !== undefined && (
        <>
          <label>
            x [m]
            <input type="number" step="any" value={x} onChange={(event) => move([event.target.valueAsNumber, y])} />
          </label>
          <label>
            y [m]
            <input type="number" step="any" value={y} onChange={(event) => move([x, event.target.valueAsNumber])} />
          </label>
          <button type="button" onClick={() => onChange(cornerRemoved(draft))}>
            {t("remove_corner")}
          </button>
        </>
      )}
    </div>
  );
}

/** What the check has said of exactly these areas. */
function Verdict({ areas, onEnabled, onClose }: { areas: Area[]; onEnabled: () => void; onClose: () => void }) {
  const { t } = useTranslation();
  const [checked, setChecked] = useState<AreasChecked | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const attempt = async (work: () => Promise<string>) => {
    setError(null);
    try {
      return await work();
    } catch (why) {
      setError(why as Error);
      return "";
    }
  };
  const check = async () => {
    setChecked(await post("/api/areas/check", { areas: documentOf(areas) }));
    return "";
  };
  const enable = async ({ id, changes }: AreasChecked) => {
    const asked = (
      <>
        <p>{texts.t("enable_ask")}</p>
        <Changes changes={changes} />
      </>
    );
    if (!(await confirmed(asked))) {
      return "";
    }
    await post("/api/areas/enable", { areas: documentOf(areas), id });
    onEnabled();
    return texts.t("areas_enabled");
  };
  return (
    <>
      {checked && <Changes changes={checked.changes} />}
      <ul className="rows bad">
        {checked?.refusals.map((one) => (
          <li key={said(one)}>
            <Said reason={one} />
          </li>
        ))}
      </ul>
      <Problem id="area_problem" error={error} />
      <div className="bar">
        <Command needs="viewer" work={() => attempt(check)}>
          {t("check_areas")}
        </Command>
        {checked && checked.refusals.length === 0 && checked.changes.length > 0 && (
          <Command className="go" needs="admin" work={() => attempt(() => enable(checked))}>
            {t("enable_areas")}
          </Command>
        )}
        {!may("admin") && <span>{t("only_admin_enables")}</span>}
        <button type="button" onClick={() => download(areas)}>
          {t("download_areas")}
        </button>
        <button type="button" onClick={onClose}>
          {t("close")}
        </button>
      </div>
    </>
  );
}

function Changes({ changes }: { changes: AreasChecked["changes"] }) {
  const { t } = useTranslation();
  const metres = (size: number) => size.toFixed(1);
  return (
    <ul className="rows" data-part="changes">
      {changes.length === 0 && <li>{t("areas_same")}</li>}
      {changes.map(({ id, kind, before, after, away, new: more }) => (
        <li key={id}>
          {id}: {t(`area_${kind}`)},{" "}
          {t("area_sizes", { before: metres(before), after: metres(after), away: metres(away), more: metres(more) })}
        </li>
      ))}
    </ul>
  );
}

function download(areas: Area[]) {
  const file = new Blob([JSON.stringify(documentOf(areas), null, 1)], { type: "application/geo+json" });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = "areas.geojson";
  link.click();
  URL.revokeObjectURL(link.href);
}
