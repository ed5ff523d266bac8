// Starting a task: it names the machines that will move, and asks once.
import { say } from "old/dom.js";
import { useTranslation } from "react-i18next";
import { confirmed } from "./confirm";
import type { Task } from "./models";
import { get, post } from "./server";
import { texts } from "./texts";

/** Resolves to the text to show; empty if the person thought better of it. */
export async function startTask(task: Task): Promise<string> {
  const { machines } = await get("/api/tasks/{task_id}/machines", { task_id: task.id });
  if (!(await confirmed(<Asked task={task} machines={machines} />))) {
    return "";
  }
  say(texts.t("starting", { id: task.id }));
  const { run_id } = await post("/api/runs", { task_id: task.id, ignore_warnings: false });
  return texts.t("started", { id: run_id });
}

function Asked({ task, machines }: { task: Task; machines: string[] }) {
  const { t } = useTranslation();
  const named = `${task.id} ${task.description}`.trim();
  return (
    <>
      <p>{t(machines.length > 0 ? "start_ask" : "start_ask_none", { task: named })}</p>
      <ul id="will_move" className="plain">
        {machines.map((name) => (
          <li key={name}>
            <strong>{name}</strong>
          </li>
        ))}
      </ul>
    </>
  );
}
