// Stored tasks that tell the same of themselves are versions of one task.
import type { Task } from "../models";

/** Groups of versions, newest first in each; a task without a description is alone. */
export function versionsOf(tasks: Task[]): Task[][] {
  const groups = Map.groupBy(tasks, (task) => (task.description === "" ? String(task.id) : `= ${task.description}`));
  return [...groups.values()].map((group) => group.toSorted((one, other) => other.id - one.id));
}
