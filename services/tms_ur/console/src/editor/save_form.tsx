// Saves what is drawn: as a new version of the task, or as the template. It needs the role that an upload needs.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { confirmed } from "../confirm";
import { may } from "../role";
import { post } from "../server";
import { described, nameIn } from "../tasks/versions";
import { texts } from "../texts";
import type { Target } from "./site";

interface Props {
  target: Target;
  text: string;
  changed: boolean;
  onSaved: (rest: string) => void; // where it is then
}

/** How many errors this very text has: what is on the screen may be of the one before. 0 where nobody can tell. */
const errorsIn = (text: string) =>
  post("/api/tasks/check", { xml: text }).then(
    (found) => found.errors.length,
    () => 0,
  );

async function saveTask(text: string, description: string, onSaved: (rest: string) => void): Promise<string> {
  const added = await post("/api/tasks", { xml: text, description });
  onSaved(String(added.id));
  return texts.t(added.already_stored ? "stored_before" : "stored", { id: added.id });
}

async function saveTemplate(text: string, { name }: Target, description: string, onSaved: (rest: string) => void) {
  await post("/api/templates", { name, xml: text, description, replace: true });
  onSaved(`template/${encodeURIComponent(name)}`);
  return texts.t("stored_template", { name });
}

export function SaveForm({ target, text, changed, onSaved }: Props) {
  const { t } = useTranslation();
  const [name, setName] = useState(nameIn(target.description));
  const [comment, setComment] = useState("");
  const isTemplate = target.kind === "template";
  const allowed = may("admin");
  const save = async () => {
    const open = isTemplate ? 0 : await errorsIn(text); // what a template leaves to its callers is no error
    const ask = isTemplate ? t("replace_ask", { name: target.name }) : open > 0 ? t("store_ask") : "";
    if (ask !== "" && !(await confirmed(ask))) {
      return "";
    }
    const description = described(name.trim(), comment.trim());
    return isTemplate ? saveTemplate(text, target, comment.trim(), onSaved) : saveTask(text, description, onSaved);
  };
  return (
    <section className="ed_save" aria-label={t("save")}>
      {!isTemplate && (
        <label className="wide">
          {t("ed_task_name")}
          <input maxLength={400} value={name} onChange={(event) => setName(event.target.value)} />
        </label>
      )}
      <label className="wide">
        {t("ed_comment")}
        <input maxLength={400} value={comment} onChange={(event) => setComment(event.target.value)} />
      </label>
      <div className="bar">
        <Command className="go" needs="admin" disabled={!changed} work={save}>
          {t(target.kind === "task" ? "ed_save_version" : "save")}
        </Command>
        {!allowed && <span>{t("ed_only_admin")}</span>}
      </div>
    </section>
  );
}
