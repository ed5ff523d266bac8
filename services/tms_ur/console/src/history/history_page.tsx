// History: past runs, and the time line of the chosen one.
import "./history.css";
import { duration } from "old/dom.js";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import type { Run } from "../models";
import { Problem } from "../problem";
import { Said } from "../said";
import { get } from "../server";
import { Table } from "../table";
import { dateTime } from "../texts";
import { useList } from "../use_list";
import { Past } from "./past";

const readRuns = () => get("/api/runs", {}, "limit=50");

/** `rest`: the run, and the moment in seconds since its begin, so that a link or a reload finds them again. */
export default function HistoryPage({ rest }: { rest: string }) {
  const { t } = useTranslation();
  const { list, error } = useList(readRuns);
  const [chosen = "", seconds = ""] = rest.split("/").map(decodeURIComponent);
  return (
    <>
      <h2>{t("history")}</h2>
      <Problem id="history_problem" error={error} />
      {list?.length === 0 && <p id="none_history">{t("none_history")}</p>}
      <Table
        id="list_history"
        label="history"
        heads={["task", "started_at", "state", "machines", "duration", "reason", "show"]}
        blocks
      >
        {list?.map((run) => (
          <Row key={run.run_id} run={run} chosen={run.run_id === chosen} />
        ))}
      </Table>
      {chosen && <Past key={chosen} id={chosen} run={list?.find((run) => run.run_id === chosen)} seconds={seconds} />}
    </>
  );
}

function Row({ run, chosen }: { run: Run; chosen: boolean }) {
  const { t } = useTranslation();
  const seconds =
    run.started_at && run.ended_at ? (Date.parse(run.ended_at) - Date.parse(run.started_at)) / 1000 : null;
  const show = () => {
    location.hash = `#history/${encodeURIComponent(run.run_id)}`;
    document.getElementById("past")?.scrollIntoView(); // of one that is there already
  };
  return (
    <tr aria-current={chosen}>
      <td>{`${run.task_id} ${run.description}`}</td>
      <td data-label={t("started_at")}>{dateTime(run.started_at)}</td>
      <td>
        <Badge state={run.state} />
      </td>
      <td data-label={t("machines")}>{run.machines.join(", ")}</td>
      <td data-label={t("duration")}>{seconds === null ? "-" : duration(seconds)}</td>
      <td className="wide">
        <Said reason={run.reason} />
      </td>
      <td>
        <button type="button" aria-label={t("show_run", { id: run.run_id })} onClick={show}>
          {t("show")}
        </button>
      </td>
    </tr>
  );
}
