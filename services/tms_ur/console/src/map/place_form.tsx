// A place on the map becomes a record, or corrects one.

import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Stored } from "../models";
import { RecordForm } from "../record_form";
import { post } from "../server";
import { texts } from "../texts";
import { type Area, flawOf } from "./areas";
import type { Flat } from "./outline";
import { fieldsOf, type Pose, poseOf } from "./pose_record";

interface Props {
  place: Flat;
  machines: string[];
  records: readonly Stored[];
  areas: readonly Area[];
  onSaved: (name: string) => void;
  onClose: () => void;
}

const NEW = "";

export function PlaceForm({ place, machines, records, areas, ...rest }: Props) {
  const { t } = useTranslation();
  const [machine, setMachine] = useState(machines[0] ?? "");
  const [record, setRecord] = useState(NEW);
  const [name, setName] = useState("");
  const [pose, setPose] = useState<Pose>({ x: round(place[0]), y: round(place[1]), heading: 0 });
  const own = records.filter((one) => one.model_name === machine && one.type === "static" && poseOf(one) !== null);
  const chosen = own.find((one) => one.record_name === record) ?? null;
  const choose = (wanted: string) => {
    const found = own.find((one) => one.record_name === wanted);
    setRecord(wanted);
    setPose({ ...pose, heading: (found && poseOf(found)?.heading) ?? pose.heading });
  };
  const known = Object.values(pose).every(Number.isFinite);
  const flaw = known ? flawOf([pose.x, pose.y], areas) : (["place_number", {}] as const);
  const save = async () => {
    const title = chosen ? record : name.trim();
    const full = `${machine}/${title}`;
    if (!chosen && records.some((one) => one.model_name === machine && one.record_name === title)) {
      throw new Error(texts.t("record_there", { name: full }));
    }
    const to = { model_name: machine, record_name: title };
    await post("/api/parameters", {
      ...to,
      fields: fieldsOf(pose, chosen),
      create: !chosen,
      type: chosen ? "" : "static",
    });
    return full;
  };
  const ready = !flaw && (chosen || name.trim() !== "");
  return (
    <RecordForm id="place_form" title={t("place_form")} save={ready ? save : null} {...rest}>
      <div className="bar">
        <label>
          {t("model")}
          <select value={machine} onChange={(event) => setMachine(event.target.value)}>
            {machines.map((one) => (
              <option key={one}>{one}</option>
            ))}
          </select>
        </label>
        <label>
          {t("record")}
          <select value={chosen ? record : NEW} onChange={(event) => choose(event.target.value)}>
            <option value={NEW}>{t("new_record")}</option>
            {own.map((one) => (
              <option key={one.record_name}>{one.record_name}</option>
            ))}
          </select>
        </label>
        {!chosen && (
          <label>
            {t("record_name")}
            <input maxLength={100} value={name} onChange={(event) => setName(event.target.value)} />
          </label>
        )}
        <Numbers pose={pose} onChange={setPose} />
      </div>
      {flaw && (
        <p className="bad" role="alert">
          {t(flaw[0], flaw[1])}
        </p>
      )}
    </RecordForm>
  );
}

const round = (metres: number) => Math.round(metres * 100) / 100;

const FIELDS = { x: "x [m]", y: "y [m]", heading: "heading" } as const;

function Numbers({ pose, onChange }: { pose: Pose; onChange: (pose: Pose) => void }) {
  const { t } = useTranslation();
  return (Object.keys(FIELDS) as (keyof Pose)[]).map((field) => (
    <label key={field}>
      {field === "heading" ? t("heading_deg") : FIELDS[field]}
      <input
        type="number"
        step="any"
        value={Number.isFinite(pose[field]) ? pose[field] : ""}
        onChange={(event) => onChange({ ...pose, [field]: event.target.valueAsNumber })}
      />
    </label>
  ));
}
