// Data: records with type, age, source and history; static ones can be edited; and the sensing inputs.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Event, RecordChange, Stored } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { Table } from "../table";
import { dateTime } from "../texts";
import { useList } from "../use_list";
import { EditRecord } from "./edit_record";
import { NewRecord } from "./new_record";
import { RecordHistory } from "./record_history";
import { Records } from "./records";
import { Sensing } from "./sensing";
import { nameOf } from "./values";

const KEPT = 200; // changes of a record that are shown
const read = async () => ({
  records: await get("/api/parameters"),
  changes: (await get("/api/audit", {}, "hours=720")).filter((event) => event.kind === "set_parameter").reverse(),
});

/** What is open: the editor of a record, or of a new one. */
type Open = Stored | "new" | null;

export default function DataPage() {
  const { t } = useTranslation();
  const { list, error, again } = useList(read);
  const [open, setOpen] = useState<Open>(null);
  const [past, setPast] = useState<{ record: Stored; changes: RecordChange[] } | null>(null);
  const records = list?.records ?? [];
  const close = () => setOpen(null);
  const saved = () => {
    close();
    again();
  };
  const showPast = async (record: Stored) => {
    const { model_name, record_name } = record;
    const query = new URLSearchParams({ model_name, record_name, limit: String(KEPT) });
    setPast({ record, changes: await get("/api/parameters/history", {}, query.toString()) });
    return "";
  };
  const shared = { onSaved: saved, onClose: close };
  return (
    <>
      <h2>{t("p_data")}</h2>
      <Problem id="data_problem" error={error} />
      {open === "new" && <NewRecord records={records} {...shared} />}
      {open !== null && open !== "new" && <EditRecord key={nameOf(open)} record={open} {...shared} />}
      <Records records={list?.records ?? null} onEdit={setOpen} onNew={() => setOpen("new")} onPast={showPast} />
      {past && <RecordHistory {...past} onClose={() => setPast(null)} />}
      <Sensing />
      <Changes changes={list?.changes ?? []} />
    </>
  );
}

function Changes({ changes }: { changes: Event[] }) {
  const { t } = useTranslation();
  return (
    <>
      <h2>{t("edits")}</h2>
      <Table id="list_changes" label="edits" heads={["at_time", "who", "target"]}>
        {changes.map((event) => (
          <tr key={event.number}>
            <td>{dateTime(event.stamp)}</td>
            <td>{event.text}</td>
            <td>{event.node}</td>
          </tr>
        ))}
      </Table>
    </>
  );
}
