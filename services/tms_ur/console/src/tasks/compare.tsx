// What differs between the chosen file and a stored task.
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Task } from "../models";
import { Problem } from "../problem";
import { post } from "../server";
import { Difference } from "./difference";
import type { Given } from "./upload";

export function Compare({ given, stored }: { given: Given; stored: Task[] }) {
  const { t } = useTranslation();
  const [id, setId] = useState("");
  const [text, setText] = useState<string | null>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    setText(null);
    setError(null);
    if (id === "") {
      return;
    }
    let left = false;
    post("/api/tasks/{task_id}/diff", { xml: given.xml }, { task_id: id }).then(
      (found) => left || setText(found.text),
      (why: Error) => left || setError(why),
    );
    return () => {
      left = true;
    };
  }, [id, given]);
  return (
    <>
      <label>
        {t("compare")}
        <select id="compare" value={id} onChange={(event) => setId(event.target.value)}>
          <option value="">-</option>
          {stored.map((task) => (
            <option key={task.id} value={task.id}>
              {`${task.id} ${task.description}`}
            </option>
          ))}
        </select>
      </label>
      <Problem error={error} />
      {text !== null && <Difference id="difference" text={text} />}
    </>
  );
}
