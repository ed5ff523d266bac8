// Stores a file as a task, or as a template that tasks call.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { confirmed } from "../confirm";
import type { Checked, ReasonView } from "../models";
import { may } from "../role";
import { post } from "../server";
import { texts } from "../texts";
import type { Given } from "./upload";

async function storeTask(xml: string, description: string, found: Checked | null): Promise<string> {
  if (found && found.errors.length > 0 && !(await confirmed(texts.t("store_ask")))) {
    return "";
  }
  const added = await post("/api/tasks", { xml, description });
  return texts.t(added.already_stored ? "stored_before" : "stored", { id: added.id });
}

/** The name of a template is that of its file. What it leaves to the tasks that call it counts as an error in the check. */
async function storeTemplate(given: Given, description: string): Promise<string> {
  const name = given.name.replace(/\.xml$/i, "");
  const wanted = { name, xml: given.xml, description };
  const store = (replace: boolean) => post("/api/templates", { ...wanted, replace });
  const added = await store(false).catch(async (error: Error & { reason?: ReasonView }) => {
    if (error.reason?.code !== "TEMPLATE_EXISTS") {
      throw error;
    }
    return (await confirmed(texts.t("replace_ask", { name }))) ? store(true) : null;
  });
  return (added && texts.t(added.already_stored ? "same_template" : "stored_template", { name })) || "";
}

interface Props {
  given: Given;
  found: Checked | null; // null: the file cannot be read
  changed: () => void;
}

export function StoreForm({ given, found, changed }: Props) {
  const { t } = useTranslation();
  const [description, setDescription] = useState("");
  if (!may("admin")) {
    return <p>{t("ed_only_admin")}</p>;
  }
  return (
    <>
      <label>
        {t("description")}
        <input
          id="description"
          maxLength={1000}
          value={description}
          onChange={(event) => setDescription(event.target.value)}
        />
      </label>
      <div className="bar">
        <Command
          id="store"
          needs="admin"
          className="go"
          disabled={found === null}
          work={() => storeTask(given.xml, description, found).finally(changed)}
        >
          {t("store")}
        </Command>
        <Command needs="admin" work={() => storeTemplate(given, description).finally(changed)}>
          {t("store_template")}
        </Command>
      </div>
    </>
  );
}
