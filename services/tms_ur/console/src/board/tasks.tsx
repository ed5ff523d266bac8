// Tasks to start. A start names the machines that will move, and asks once.

import { say } from "old/dom.js";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { confirmed } from "../confirm";
import type { Checked, Finding, Task } from "../models";
import { Problem } from "../problem";
import { Said } from "../said";
import { get, post } from "../server";
import { texts } from "../texts";
import { useList } from "../use_list";

const readTasks = () => get("/api/tasks");

async function start(task: Task): Promise<string> {
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
              <Command className="go" label={t("run_task", { id: task.id })} work={() => start(task)}>
                {t("run")}
              </Command>
              <Command label={t("check_task", { id: task.id })} work={() => check(task.id)}>
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

function Findings({ found }: { found: Checked }) {
  const { t } = useTranslation();
  if (found.errors.length + found.warnings.length === 0) {
    return <p className="good">{t("check_good")}</p>;
  }
  return (
    <>
      <Listed kind="errors" found={found.errors} />
      <Listed kind="warnings" found={found.warnings} />
    </>
  );
}

function Listed({ kind, found }: { kind: "errors" | "warnings"; found: Finding[] }) {
  const { t } = useTranslation();
  if (found.length === 0) {
    return null;
  }
  return (
    <>
      <h3>
        {t(kind)} ({found.length})
      </h3>
      <ul className={kind}>
        {found.map((one, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: the list is made anew as a whole
          <li key={index}>
            <Said reason={one.reason} />
          </li>
        ))}
      </ul>
    </>
  );
}
