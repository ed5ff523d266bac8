// What a task can be made of: the nodes of trees, as the server's TreeNodesModel tells them, and ready leaves of each
// machine of the site.
import { copied } from "./edits";
import { type Element, encoded, everyElement, parse, valueIn } from "./xml";

export interface Port {
  name: string;
  type: string; // as in C++, empty: any
  fallback: string; // its value where none is given, empty: none
  help: string;
}

export type Kind = "action" | "condition" | "control" | "decorator" | "subtree";

export interface NodeType {
  id: string;
  kind: Kind;
  builtin: boolean; // Groot knows it without a model
  help: string;
  ports: Port[];
  model: string; // its entry in TreeNodesModel
}

export type Types = Map<string, NodeType>;

const KINDS: Record<string, Kind> = {
  Action: "action",
  Condition: "condition",
  Control: "control",
  Decorator: "decorator",
  Subtree: "subtree",
};
const HELP = /^\s*\S+(?: \(versions? [^)]*\))?: ([\s\S]*)$/; // "ID (version 5): text"
export const CALL = "ExecuteSubtask"; // an action in whose place the tree of a template comes

/** Every node by its ID, from the server's document; none while it has no text. */
export function typesOf(xml: string): Types {
  const types: Types = new Map();
  const entries = xml === "" ? [] : [...everyElement(parse(xml))].filter((one) => one.parent?.tag === "TreeNodesModel");
  for (const entry of entries) {
    const id = valueIn(entry, "ID") ?? "";
    types.set(id, {
      id,
      kind: KINDS[entry.tag] ?? "action",
      builtin: valueIn(entry, "builtin") === "true",
      help: HELP.exec(entry.comment)?.[1]?.trim() ?? "",
      ports: entry.children.map((port) => portOf(port, xml)),
      model: copied(xml, entry),
    });
  }
  return types;
}

const portOf = (port: Element, xml: string): Port => ({
  name: valueIn(port, "name")?.trim() ?? "",
  type: valueIn(port, "type") ?? "",
  fallback: valueIn(port, "default") ?? "",
  help: port.empty ? "" : xml.slice(port.open, port.close).trim(),
});

/** The text of a new node, as Groot writes it: those that it knows by their tag, others by their ID. */
export function sourceOf(type: NodeType, ports: Record<string, string> = {}): string {
  const given = Object.entries(ports).map(([name, value]) => ` ${name}="${encoded(value)}"`);
  const tag = type.kind[0]?.toUpperCase() + type.kind.slice(1);
  return `<${type.builtin ? type.id : `${tag} ID="${type.id}"`}${given.join("")}/>`;
}

export interface Entry {
  label: string;
  help: string;
  type: string; // ID
  source: string;
}

export interface Group {
  title: string; // of a machine its name, else a key of the texts
  machine: boolean;
  entries: Entry[];
}

export interface Worker {
  name: string;
  model: string;
  subtasks: string[];
}

const hasPort = (type: NodeType, name: string) => type.ports.some((port) => port.name === name);

/** The leaf with which a machine is asked, and its port for what it is asked: version 6 of the C++ system calls subtasks primitives. */
function leafFor(worker: Worker, subtask: string, types: Types): { type: NodeType; port: string } | null {
  const port = subtask.startsWith("primitive_") ? "primitive_name" : "subtask_name";
  const leaves = [...types.values()].filter(
    (type) => hasPort(type, "model_name") && hasPort(type, port) && type.id !== CALL,
  );
  const model = (type: NodeType) => type.ports.find((one) => one.name === "model_name")?.fallback;
  const kind = `leafnode${subtask.split("_")[1]}`;
  const type =
    leaves.filter((one) => model(one) === worker.model).sort((a, b) => a.id.length - b.id.length)[0] ??
    leaves.find((one) => one.id.toLowerCase() === kind) ??
    types.get("LeafNodeCommon");
  return type && hasPort(type, port) ? { type, port } : null;
}

function leavesOf(worker: Worker, types: Types): Group {
  const entries = worker.subtasks.flatMap((subtask) => {
    const leaf = leafFor(worker, subtask, types);
    if (leaf === null) {
      return [];
    }
    const { type, port } = leaf;
    return [
      {
        label: subtask,
        help: type.help,
        type: type.id,
        source: sourceOf(type, { model_name: worker.name, [port]: subtask }),
      },
    ];
  });
  return { title: worker.name, machine: true, entries };
}

/** Everything that can be put into a tree: `trees` are the others of the task. */
export function groupsOf(types: Types, workers: Worker[], trees: string[], templates: string[]): Group[] {
  const nodes = (title: string, of: (type: NodeType) => boolean): Group => ({
    title,
    machine: false,
    entries: [...types.values()]
      .filter(of)
      .map((type) => ({ label: type.id, help: type.help, type: type.id, source: sourceOf(type) })),
  });
  const call = types.get(CALL);
  const isLeaf = (type: NodeType) => hasPort(type, "subtask_name") || hasPort(type, "primitive_name");
  return [
    nodes("ed_controls", (type) => type.kind === "control"),
    ...workers.map((worker) => leavesOf(worker, types)),
    nodes("ed_decorators", (type) => type.kind === "decorator"),
    nodes("ed_others", (type) => (type.kind === "action" || type.kind === "condition") && !isLeaf(type)),
    {
      title: "ed_subtrees",
      machine: false,
      entries: trees.map((id) => ({ label: id, help: "", type: "SubTree", source: `<SubTree ID="${encoded(id)}"/>` })),
    },
    {
      title: "templates",
      machine: false,
      entries: templates.flatMap((name) =>
        call ? [{ label: name, help: call.help, type: CALL, source: sourceOf(call, { subtask_name: name }) }] : [],
      ),
    },
  ].filter((group) => group.entries.length > 0);
}
