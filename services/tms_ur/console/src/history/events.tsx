// The journal up to the cursor as a table: filtered and folded; an event puts the cursor where it is.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { countAt, type Journal } from "../journal/journal";
import type { Event } from "../models";
import { Said } from "../said";
import { Table } from "../table";
import { clock, said } from "../texts";
import { kindsOf, type Row, rowsOf, type Wanted } from "./rows";

/** What people read of it: a reason, or plain text. */
export const textOf = (event: Event) => said(event.reason) || event.text;

interface Props {
  journal: Journal;
  time: number; // ms, of the cursor
  onTime: (time: number) => void;
}

export function Events({ journal, time, onTime }: Props) {
  const { t } = useTranslation();
  const [wanted, setWanted] = useState<Wanted>({ kind: "", words: "", fold: true });
  const rows = rowsOf(journal.events, countAt(journal, time), wanted, textOf);
  const templates = new Map(journal.tree?.paths.map((path, index) => [path, journal.tree?.templates?.[index] ?? ""]));
  const go = ({ event }: Row) => onTime(journal.times[journal.events.indexOf(event)] ?? time);
  return (
    <>
      <h3>{t("journal")}</h3>
      <Filters kinds={kindsOf(journal.events)} wanted={wanted} onWanted={setWanted} />
      <Table id="list_events" label="journal" heads={["at_time", "event", "node", "text"]}>
        {rows.map((row) => (
          <tr key={row.event.number}>
            <td>
              <button type="button" className="plain_time" onClick={() => go(row)}>
                {clock(row.event.stamp)}
              </button>
            </td>
            <td>{t(`kind_${row.event.kind}`, { defaultValue: row.event.kind })}</td>
            <td data-part="node">
              {row.event.node}
              {templates.get(row.event.node) && ` (${t("from_template", { name: templates.get(row.event.node) })})`}
            </td>
            <td>
              <Said reason={row.event.reason} text={textOf(row.event)} />
              {row.times > 1 && ` ×${row.times}`}
            </td>
          </tr>
        ))}
      </Table>
    </>
  );
}

interface FilterProps {
  kinds: string[];
  wanted: Wanted;
  onWanted: (wanted: Wanted) => void;
}

function Filters({ kinds, wanted, onWanted }: FilterProps) {
  const { t } = useTranslation();
  return (
    <div className="bar">
      <label>
        {t("event")}
        <select value={wanted.kind} onChange={(event) => onWanted({ ...wanted, kind: event.target.value })}>
          <option value="">{t("all_kinds")}</option>
          {kinds.map((kind) => (
            <option key={kind} value={kind}>
              {t(`kind_${kind}`, { defaultValue: kind })}
            </option>
          ))}
        </select>
      </label>
      <label>
        {t("filter")}
        <input
          type="search"
          value={wanted.words}
          onChange={(event) => onWanted({ ...wanted, words: event.target.value })}
        />
      </label>
      <button type="button" aria-pressed={wanted.fold} onClick={() => onWanted({ ...wanted, fold: !wanted.fold })}>
        {wanted.fold ? "☑" : "☐"} {t("fold")}
      </button>
    </div>
  );
}
