// What the editor knows of the site, and the text that it begins with.
import type { Stored, Task } from "../models";
import { get } from "../server";
import { emptyTask } from "./groot";
import { type Types, typesOf, type Worker } from "./palette";

export interface Site {
  types: Types;
  workers: Worker[];
  templates: string[]; // their names
  records: Stored[];
  tasks: Task[];
}

export interface Target {
  kind: "new" | "task" | "template";
  name: string; // of a template, or the number of a task
  description: string; // of a task
  text: string;
  stored: string; // the text as the database has it, empty: it has none
}

export const readRecords = () => get("/api/parameters");

export async function readSite(): Promise<Site> {
  const [palette, templates, records, tasks] = await Promise.all([
    get("/api/palette"),
    get("/api/templates"),
    readRecords(),
    get("/api/tasks"),
  ]);
  return {
    types: typesOf(palette.xml),
    workers: palette.machines,
    templates: templates.map((one) => one.name),
    records,
    tasks,
  };
}

/** `rest`: what stands behind the page's name in the address: new, a number, or template/NAME. */
export async function readTarget(rest: string): Promise<Target> {
  const [kind = "", ...name] = rest.split("/");
  if (kind === "template") {
    const called = decodeURIComponent(name.join("/"));
    const { xml } = await get("/api/templates/{name}", { name: called });
    return { kind: "template", name: called, description: "", text: xml, stored: xml };
  }
  if (kind === "new" || kind === "") {
    return { kind: "new", name: "", description: "", text: emptyTask("MainTree"), stored: "" };
  }
  const task = await get("/api/tasks/{task_id}", { task_id: kind });
  return { kind: "task", name: kind, description: task.description, text: task.xml, stored: task.xml };
}
