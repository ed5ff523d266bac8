// All records of the site as a table.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Age } from "../age";
import { Command } from "../command";
import type { Stored } from "../models";
import { may } from "../role";
import { Table } from "../table";
import { listed, nameOf } from "./values";

interface Props {
  records: Stored[] | null; // null: not read yet
  onEdit: (record: Stored) => void;
  onNew: () => void;
  onPast: (record: Stored) => Promise<string>;
}

export function Records({ records, onEdit, onNew, onPast }: Props) {
  const { t } = useTranslation();
  const [filter, setFilter] = useState("");
  const found = records?.filter((record) => nameOf(record).toLowerCase().includes(filter.toLowerCase()));
  return (
    <>
      <label>
        {t("filter")}
        <input id="record_filter" type="search" value={filter} onChange={(event) => setFilter(event.target.value)} />
      </label>
      {may("admin") && (
        <button type="button" onClick={onNew}>
          {t("new_record")}
        </button>
      )}
      {found?.length === 0 && <p id="none_records">{t("none_records")}</p>}
      <Table id="list_records" label="p_data" heads={["record", "type", "age", "source", "values", "commands"]} blocks>
        {found?.map((record) => (
          <Row key={nameOf(record)} record={record} onEdit={onEdit} onPast={onPast} />
        ))}
      </Table>
    </>
  );
}

type RowProps = Pick<Props, "onEdit" | "onPast"> & { record: Stored };

function Row({ record, onEdit, onPast }: RowProps) {
  const { t } = useTranslation();
  const name = nameOf(record);
  return (
    <tr>
      <td>{name}</td>
      <td data-label={t("type")}>{t(record.type)}</td>
      <td data-part="age" data-label={t("age")}>
        <Age stamp={record.updated_at} />
      </td>
      <td data-label={t("source")}>{record.source}</td>
      <td className="values wide">{listed(record.values, record)}</td>
      <td className="bar">
        {record.type === "static" && may("admin") && (
          <button type="button" aria-label={t("edit_record", { name })} onClick={() => onEdit(record)}>
            {t("edit")}
          </button>
        )}
        <Command needs="viewer" label={t("history_of", { name })} work={() => onPast(record)}>
          {t("record_history")}
        </Command>
      </td>
    </tr>
  );
}
