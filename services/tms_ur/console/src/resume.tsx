// Going on with an interrupted run, or giving it up.

import { COMMANDS } from "old/actions.js";
import { useTranslation } from "react-i18next";
import { confirmed } from "./confirm";
import type { ResumePlan } from "./models";
import { get, post } from "./server";
import { texts } from "./texts";

/** Says what it would do first, and asks. */
export async function resumeRun(run_id: string): Promise<string> {
  const plan = await get("/api/runs/{run_id}/resume", { run_id });
  if (!(await confirmed(<Plan plan={plan} />))) {
    return "";
  }
  await post("/api/runs/{run_id}/resume", {}, { run_id });
  return texts.t("started", { id: run_id });
}

export async function abandonRun(run_id: string): Promise<string> {
  if (!(await confirmed(texts.t("abandon_ask", { id: run_id })))) {
    return "";
  }
  await post("/api/runs/{run_id}/abandon", {}, { run_id });
  return texts.t("was_abandoned", { id: run_id });
}

COMMANDS.resume = ({ run }) => resumeRun(String(run));

function Plan({ plan }: { plan: ResumePlan }) {
  const { t } = useTranslation();
  return (
    <>
      <p>{t("resume_ask", { task: plan.task_id, count: plan.done.length })}</p>
      <p>{t(plan.next.length > 0 ? "resume_next" : "resume_next_none")}</p>
      <ul className="plain">
        {plan.next.map((text) => (
          <li key={text}>{text}</li>
        ))}
      </ul>
    </>
  );
}
