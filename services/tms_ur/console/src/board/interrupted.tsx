// Runs that a lost scheduler left open: a person resumes or abandons them.
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { Command } from "../command";
import type { Run } from "../models";
import { abandonRun, resumeRun } from "../resume";
import { Said } from "../said";

export function Interrupted({ runs, changed }: { runs: Run[]; changed: () => void }) {
  const { t } = useTranslation();
  if (runs.length === 0) {
    return null;
  }
  const after = (work: Promise<string>) => work.finally(changed);
  return (
    <section>
      <h2>{t("interrupted_runs")}</h2>
      <ul id="list_interrupted" className="rows">
        {runs.map((run) => (
          <li key={run.run_id}>
            <strong>
              {t("task")} {run.task_id}
            </strong>
            <Badge state={run.state} />
            <span>{run.machines.join(", ")}</span>
            <span className="grow">
              <Said reason={run.reason} done="resume" />
            </span>
            <Command
              className="go"
              label={t("resume_run", { id: run.run_id })}
              work={() => after(resumeRun(run.run_id))}
            >
              {t("resume")}
            </Command>
            <Command label={t("abandon_run", { id: run.run_id })} work={() => after(abandonRun(run.run_id))}>
              {t("abandon")}
            </Command>
          </li>
        ))}
      </ul>
    </section>
  );
}
