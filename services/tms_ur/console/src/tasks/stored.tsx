// The stored tasks: the newest version of each, older ones on request.
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { confirmed } from "../confirm";
import type { Task } from "../models";
import { get, post } from "../server";
import { startTask } from "../start";
import { Table } from "../table";
import { dateTime, texts } from "../texts";
import { Difference } from "./difference";
import { Moved } from "./moved";
import { versionsOf } from "./versions";

async function remove(id: number): Promise<string> {
  if (!(await confirmed(texts.t("remove_ask", { id })))) {
    return "";
  }
  await post("/api/tasks/{task_id}/remove", {}, { task_id: id });
  return texts.t("removed", { id });
}

async function download(id: number): Promise<string> {
  const { xml } = await get("/api/tasks/{task_id}", { task_id: id });
  const url = URL.createObjectURL(new Blob([xml], { type: "text/xml" }));
  Object.assign(document.createElement("a"), { href: url, download: `task_${id}.xml` }).click();
  URL.revokeObjectURL(url);
  return "";
}

/** How a version differs from the one before it, as text. */
async function difference(task: Task, before: Task): Promise<string> {
  const { xml } = await get("/api/tasks/{task_id}", { task_id: task.id });
  return (await post("/api/tasks/{task_id}/diff", { xml }, { task_id: before.id })).text;
}

export function Stored({ tasks, changed }: { tasks: Task[]; changed: () => void }) {
  const [open, setOpen] = useState(new Set<number>());
  const [shown, setShown] = useState<Shown | null>(null);
  const toggle = (id: number, isOpen: boolean) =>
    setOpen((before) => new Set(isOpen ? [...before].filter((one) => one !== id) : [...before, id]));
  const compare = async (task: Task, before: Task) => {
    setShown({ text: await difference(task, before), task, before });
    return "";
  };
  return (
    <>
      <Table id="list_stored" label="tasks" heads={["task", "machines", "description", "added_at", "commands"]} blocks>
        {versionsOf(tasks).flatMap((versions) => {
          const first = versions[0];
          const isOpen = first !== undefined && open.has(first.id);
          return (isOpen ? versions : versions.slice(0, 1)).map((task, index) => (
            <Row key={task.id} task={task} changed={changed} before={versions[index + 1]} compare={compare}>
              {index === 0 && versions.length > 1 && (
                <Versions count={versions.length - 1} open={isOpen} onToggle={() => toggle(task.id, isOpen)} />
              )}
            </Row>
          ));
        })}
      </Table>
      {shown !== null && <Compared {...shown} />}
    </>
  );
}

interface Shown {
  text: string; // of the difference
  task: Task;
  before: Task;
}

/** It stands below a long table: the page goes there. */
function Compared({ text, task, before }: Shown) {
  const { t } = useTranslation();
  const section = useRef<HTMLElement>(null);
  const label = t("compare_versions", { id: task.id, before: before.id });
  // biome-ignore lint/correctness/useExhaustiveDependencies: another difference is shown
  useEffect(() => void section.current?.scrollIntoView(), [task, before]);
  return (
    <section id="versions" aria-label={label} ref={section}>
      <h3>{label}</h3>
      <a className="button" href={`#editor/${task.id}/difference/${before.id}`}>
        {t("difference_picture")}
      </a>
      <Difference id="version_difference" text={text} />
    </section>
  );
}

function Versions({ count, open, onToggle }: { count: number; open: boolean; onToggle: () => void }) {
  const { t } = useTranslation();
  return (
    <button type="button" aria-expanded={open} onClick={onToggle}>
      {open ? "▾" : "▸"} {t("older_versions", { count })}
    </button>
  );
}

interface RowProps {
  task: Task;
  before: Task | undefined; // the version before it
  changed: () => void;
  compare: (task: Task, before: Task) => Promise<string>;
  children: React.ReactNode;
}

function Row({ task, before, changed, compare, children }: RowProps) {
  const { t } = useTranslation();
  const { id } = task;
  return (
    <tr data-task={id}>
      <td>{id}</td>
      <td data-label={t("machines")}>
        <Moved task={task} />
      </td>
      <td className="wide">{task.description}</td>
      <td data-label={t("added_at")}>{dateTime(task.added_at)}</td>
      <td className="bar">
        <Command className="go" label={t("start_task", { id })} work={() => startTask(task)}>
          {t("start")}
        </Command>
        <a className="button" href={`#editor/${id}`} aria-label={t("ed_edit_task", { id })}>
          {t("edit")}
        </a>
        <Command needs="viewer" label={t("download_task", { id })} work={() => download(id)}>
          {t("download")}
        </Command>
        <Command needs="admin" label={t("remove_task", { id })} work={() => remove(id).finally(changed)}>
          {t("remove")}
        </Command>
        {before && (
          <Command
            needs="viewer"
            label={t("compare_versions", { id, before: before.id })}
            work={() => compare(task, before)}
          >
            {t("difference")}
          </Command>
        )}
        {children}
      </td>
    </tr>
  );
}
