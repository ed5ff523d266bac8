// Stored tasks of one name are versions of one task. Its description is the name, and what a version is about.
import type { Task } from "../models";

const BETWEEN = " | ";

/** The name of a task in its description. */
export const nameIn = (description: string) => description.split(BETWEEN)[0] ?? "";

/** The description of a version of a task. */
export const described = (name: string, comment: string) => [name, comment].filter(Boolean).join(BETWEEN);

/** Groups of versions, newest first in each; a task without a description is alone. */
export function versionsOf(tasks: Task[]): Task[][] {
  const groups = Map.groupBy(tasks, ({ id, description }) =>
    description === "" ? String(id) : `= ${nameIn(description)}`,
  );
  return [...groups.values()].map((group) => group.toSorted((one, other) => other.id - one.id));
}
