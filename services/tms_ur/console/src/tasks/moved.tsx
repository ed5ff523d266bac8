// The machines that a task moves: its tree and its templates name them. The database keeps one of them with the task.
import { useEffect, useState } from "react";
import type { Task } from "../models";
import { get } from "../server";

/** The one of the database until the server has told them, and where none of them is at this site. */
export function Moved({ task: { id, model_name } }: { task: Task }) {
  const [machines, setMachines] = useState<string[] | null>(null);
  useEffect(() => {
    let left = false;
    get("/api/tasks/{task_id}/machines", { task_id: id }).then(
      (found) => left || setMachines(found.machines),
      () => {}, // as where a template is missing: the check of the task tells it
    );
    return () => {
      left = true;
    };
  }, [id]);
  return machines?.join(", ") || model_name;
}
