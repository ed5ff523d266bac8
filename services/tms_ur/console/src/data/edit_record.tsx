// Changes fields of a static record. Documents are not edited here.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Stored } from "../models";
import { RecordForm } from "../record_form";
import { post } from "../server";
import { exact, nameOf, type Type, typed } from "./values";

interface Props {
  record: Stored;
  onSaved: () => void;
  onClose: () => void;
}

export function EditRecord({ record, ...rest }: Props) {
  const { t } = useTranslation();
  const [changed, setChanged] = useState<Record<string, string>>({});
  const before = (field: string) => exact(record.values[field] ?? null, record.types[field]);
  const fields = Object.keys(record.values).filter((field) => record.types[field] !== "document");
  const save = async () => {
    const given = Object.entries(changed)
      .filter(([field, text]) => text !== before(field))
      .map(([field, text]) => typed(field, record.types[field] as Type, text));
    const { model_name, record_name } = record;
    await post("/api/parameters", { model_name, record_name, fields: given, create: false, type: "" });
    return nameOf(record);
  };
  return (
    <RecordForm id="editor" jump title={t("edit_record", { name: nameOf(record) })} save={save} {...rest}>
      {fields.map((field) => (
        <label key={field}>
          {[field, record.units[field] && `[${record.units[field]}]`, `(${t(`type_${record.types[field]}`)})`]
            .filter(Boolean)
            .join(" ")}
          <input
            data-field={field}
            value={changed[field] ?? before(field)}
            onChange={(event) => setChanged({ ...changed, [field]: event.target.value })}
          />
        </label>
      ))}
    </RecordForm>
  );
}
