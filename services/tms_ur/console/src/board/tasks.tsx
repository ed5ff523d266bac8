// Tasks to start.

import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { Findings } from "../findings";
import type { Checked } from "../models";
import { Problem } from "../problem";
import { get, post } from "../server";
import { startTask } from "../start";
import { useList } from "../use_list";

const readTasks = () => get("/api/tasks");

export function Tasks() {
  const { t } = useTranslation();
  const { list, error } = useList(readTasks);
  const [found, setFound] = useState<Checked | null>(null);
  const check = async (id: number) => {
    const { xml } = await get("/api/tasks/{task_id}", { task_id: id });
    setFound(await post("/api/tasks/check", { xml }));
    return "";
  };
  return (
    <section>
      <h2>{t("tasks")}</h2>
      <Problem id="run_problem" error={error} />
      {list?.length === 0 && (
        <p id="none_tasks">
          <a className="button" href="#tasks">
            {t("none_tasks")}
          </a>
        </p>
      )}
      <ul id="list_tasks" className="rows">
        {list?.map((task) => (
          <li key={task.id}>
            <strong>{task.id}</strong>
            <span className="grow">{task.description}</span>
            <span className="bar">
              <Command className="go" label={t("run_task", { id: task.id })} work={() => startTask(task)}>
                {t("run")}
              </Command>
              <Command needs="viewer" label={t("check_task", { id: task.id })} work={() => check(task.id)}>
                {t("check")}
              </Command>
            </span>
          </li>
        ))}
      </ul>
      <div id="checked" role="status">
        {found && <Findings found={found} />}
      </div>
    </section>
  );
}
