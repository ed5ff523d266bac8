// Makes a static record with its first fields.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Stored } from "../models";
import { RecordForm } from "../record_form";
import { post } from "../server";
import { texts } from "../texts";
import { nameOf, TYPES, type Type, typed } from "./values";

interface Field {
  name: string;
  type: Type;
  text: string;
}

interface Props {
  records: Stored[];
  machine?: string; // whose it will be; a person may tell another
  onSaved: (name: string) => void;
  onClose: () => void;
}

const EMPTY: Field = { name: "", type: "double", text: "" };

export function NewRecord({ records, machine = "", ...rest }: Props) {
  const { t } = useTranslation();
  const [model, setModel] = useState(machine);
  const [name, setName] = useState("");
  const [fields, setFields] = useState([EMPTY]);
  const save = async () => {
    const full = `${model.trim()}/${name.trim()}`;
    const given = fields.map((field) => typed(field.name.trim(), field.type, field.text.trim()));
    if (records.some((one) => nameOf(one) === full)) {
      throw new Error(texts.t("record_there", { name: full }));
    }
    const place = { model_name: model.trim(), record_name: name.trim() };
    await post("/api/parameters", { ...place, fields: given, create: true, type: "static" });
    return full;
  };
  const change = (index: number, field: Field) => setFields(fields.with(index, field));
  return (
    <RecordForm id="editor" jump title={t("new_record")} save={save} {...rest}>
      <label>
        {t("model")}
        <input id="new_model" maxLength={64} value={model} onChange={(event) => setModel(event.target.value)} />
      </label>
      <label>
        {t("record")}
        <input id="new_name" maxLength={100} value={name} onChange={(event) => setName(event.target.value)} />
      </label>
      <div id="new_fields">
        {fields.map((field, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: fields are only added at the end
          <FieldRow key={index} field={field} onChange={(changed) => change(index, changed)} />
        ))}
      </div>
      <button type="button" onClick={() => setFields([...fields, EMPTY])}>
        {t("add_field")}
      </button>
    </RecordForm>
  );
}

function FieldRow({ field, onChange }: { field: Field; onChange: (field: Field) => void }) {
  const { t } = useTranslation();
  return (
    <div className="bar new_field">
      <input
        aria-label={t("field_name")}
        placeholder={t("field_name")}
        maxLength={100}
        value={field.name}
        onChange={(event) => onChange({ ...field, name: event.target.value })}
      />
      <select
        aria-label={t("type")}
        value={field.type}
        onChange={(event) => onChange({ ...field, type: event.target.value as Type })}
      >
        {TYPES.map((type) => (
          <option key={type} value={type}>
            {t(`type_${type}`)}
          </option>
        ))}
      </select>
      <input
        aria-label={t("values")}
        placeholder="-1.05"
        value={field.text}
        onChange={(event) => onChange({ ...field, text: event.target.value })}
      />
    </div>
  );
}
