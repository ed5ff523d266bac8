// Runs that go on now, and why one does not move on.

import { cancelRun } from "old/actions.js";
import { siteNow } from "old/server.js";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { Command } from "../command";
import type { ActiveRun } from "../models";
import { Said } from "../said";
import { said, timeOfDay } from "../texts";

export function ActiveRuns({ runs }: { runs: ActiveRun[] }) {
  const { t } = useTranslation();
  return (
    <section>
      <h2>{t("active")}</h2>
      <div className="one_run">
        {runs.length === 0 && <p id="none_active">{t("none_active")}</p>}
        <ul id="list_active" className="rows">
          {runs.map((run) => (
            <Row key={run.run_id} run={run} />
          ))}
        </ul>
      </div>
    </section>
  );
}

function Row({ run }: { run: ActiveRun }) {
  const { t } = useTranslation();
  const since = run.reason_since ? ` (${t("since", { time: timeOfDay(run.reason_since, siteNow()) })})` : "";
  return (
    <li>
      <strong>
        {t("task")} {run.task_id}
      </strong>
      <a className="button" href={`#tree/${encodeURIComponent(run.run_id)}`}>
        {t("p_tree")}
      </a>
      <Command className="stop" label={t("cancel_run", { id: run.run_id })} work={() => cancelRun(run.run_id)}>
        {t("cancel")}
      </Command>
      {/* On lines of its own: what changes must not move a button from under a pointer. */}
      <div className="told">
        <Badge state={run.state} />
        <span>{run.machines.join(", ")}</span>
        <span data-part="reason">
          <Said reason={run.reason} text={run.reason ? said(run.reason) + since : ""} done="cancel" />
        </span>
      </div>
    </li>
  );
}
