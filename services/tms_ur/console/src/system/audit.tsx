// Who did what, newest first.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Event } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { Table } from "../table";
import { dateTime } from "../texts";
import { useList } from "../use_list";

const read = async () => (await get("/api/audit")).reverse();

export function Audit() {
  const { t } = useTranslation();
  const { list, error } = useList(read);
  const [words, setWords] = useState("");
  const did = ({ kind, values }: Event) => {
    const times = Number(values.times) > 1 ? ` ×${values.times}` : ""; // refusals of a minute are one entry
    return t(`did_${kind}`) + times;
  };
  const holds = (event: Event) =>
    `${event.text} ${did(event)} ${event.node}`.toLowerCase().includes(words.toLowerCase());
  return (
    <>
      <h2>{t("audit")}</h2>
      <Problem id="audit_problem" error={error} />
      <label>
        {t("filter")}
        <input id="audit_filter" type="search" value={words} onChange={(event) => setWords(event.target.value)} />
      </label>
      {list?.length === 0 && <p id="none_audit">{t("none_audit")}</p>}
      <Table id="list_audit" label="audit" heads={["at_time", "who", "what", "target"]}>
        {list?.filter(holds).map((event) => (
          <tr key={event.number}>
            <td>{dateTime(event.stamp)}</td>
            <td>{event.text}</td>
            <td>{did(event)}</td>
            <td>{event.node}</td>
          </tr>
        ))}
      </Table>
    </>
  );
}
