// Tasks: a file from Groot is checked, compared and stored here; what is stored, with its versions.
import { useTranslation } from "react-i18next";
import type { Template } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { Table } from "../table";
import { dateTime } from "../texts";
import { useList } from "../use_list";
import { Stored } from "./stored";
import { Upload } from "./upload";

const read = async () => ({ tasks: await get("/api/tasks"), templates: await get("/api/templates") });

export default function TasksPage() {
  const { t } = useTranslation();
  const { list, error, again } = useList(read);
  const tasks = list?.tasks ?? [];
  return (
    <>
      <Upload stored={tasks} changed={again} />
      <h2>{t("tasks")}</h2>
      <p>
        <a className="button" href="#editor/new">
          {t("ed_draw")}
        </a>
      </p>
      <Problem id="tasks_problem" error={error} />
      {list !== null && tasks.length === 0 && <p id="none_stored">{t("none_tasks_here")}</p>}
      <Stored tasks={tasks} changed={again} />
      <h2>{t("templates")}</h2>
      {list?.templates.length === 0 && <p id="no_templates">{t("none_templates")}</p>}
      <Templates templates={list?.templates ?? []} />
    </>
  );
}

function Templates({ templates }: { templates: Template[] }) {
  const { t } = useTranslation();
  return (
    <Table id="list_templates" label="templates" heads={["name", "model", "description", "added_at"]} blocks>
      {templates.map((template) => (
        <tr key={template.name}>
          <td data-part="name">
            <a href={`#editor/template/${encodeURIComponent(template.name)}`}>{template.name}</a>
          </td>
          <td data-label={t("model")}>{template.model_name}</td>
          <td>{template.description}</td>
          <td data-label={t("added_at")}>{dateTime(template.added_at)}</td>
        </tr>
      ))}
    </Table>
  );
}
