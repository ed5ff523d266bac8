// A task as its editor sees it: trees of nodes over the elements of the text.
import { inserted } from "./edits";
import type { Kind, NodeType, Types } from "./palette";
import { type Element, encoded, parse, valueIn } from "./xml";

export interface EditNode {
  path: string; // "0" is the root of its tree, "0.1" that one's second child
  element: Element;
  type: string;
  kind: Kind;
  machine: string; // empty where it names none
  label: string; // the goal of a leaf, else a name of its own, else its ports
  room: number; // how many children it can have
  children: EditNode[];
}

export interface EditTree {
  id: string;
  element: Element;
  root: EditNode | null;
  nodes: Map<string, EditNode>;
}

const EXPLICIT = ["Action", "Condition", "Control", "Decorator"];
const SUBTREES = ["SubTree", "SubTreePlus"];
const RESERVED = ["ID", "name", "_description"]; // attributes that are no ports
const ROOM: Record<Kind, number> = {
  action: 0,
  condition: 0,
  subtree: 0,
  decorator: 1,
  control: Number.POSITIVE_INFINITY,
};

export const typeOf = (element: Element) =>
  (EXPLICIT.includes(element.tag) ? valueIn(element, "ID") : undefined) ?? element.tag;

function kindOf(element: Element, types: Types): Kind {
  if (SUBTREES.includes(element.tag)) {
    return "subtree";
  }
  const told = EXPLICIT.includes(element.tag) ? (element.tag.toLowerCase() as Kind) : "action";
  return types.get(typeOf(element))?.kind ?? (told === "action" && element.children.length > 0 ? "control" : told);
}

/** Its attributes that are ports. */
export const portsOf = (element: Element) => element.attributes.filter((one) => !RESERVED.includes(one.name));

function labelOf(element: Element): string {
  const value = (name: string) => valueIn(element, name);
  const goal = [
    value("subtask_name") || value("primitive_name"),
    value("record_name") || value("target_record_name"),
  ].filter(Boolean);
  const ports = portsOf(element).map((one) => `${one.name}=${one.value}`);
  const own = SUBTREES.includes(element.tag) ? value("ID") : value("name");
  return goal.join(" ") || own || ports.join(" ");
}

function nodeOf(element: Element, path: string, types: Types, nodes: Map<string, EditNode>): EditNode {
  const kind = kindOf(element, types);
  const node: EditNode = {
    path,
    element,
    type: typeOf(element),
    kind,
    machine: valueIn(element, "model_name") ?? "",
    label: labelOf(element),
    room: ROOM[kind],
    children: [],
  };
  nodes.set(path, node);
  node.children = element.children.map((child, index) => nodeOf(child, `${path}.${index}`, types, nodes));
  return node;
}

/** The trees of a task; throws an XmlError. */
export function treesOf(text: string, types: Types): EditTree[] {
  const trees = parse(text).children.filter((one) => one.tag === "BehaviorTree");
  return trees.map((element, index) => {
    const nodes = new Map<string, EditNode>();
    const [first] = element.children;
    const root = first === undefined ? null : nodeOf(first, "0", types, nodes);
    return { id: valueIn(element, "ID") ?? `BehaviorTree_${index}`, element, root, nodes };
  });
}

export const mainOf = (text: string) => valueIn(parse(text), "main_tree_to_execute") ?? "";

export const parentPath = (path: string) => path.slice(0, Math.max(0, path.lastIndexOf(".")));
export const indexIn = (path: string) => Number(path.slice(path.lastIndexOf(".") + 1));

const SLASHES = "<!-- ////////// -->";

/** The text of a task in which nothing is drawn yet. */
export const emptyTask = (id: string) => `<?xml version="1.0"?>
<root main_tree_to_execute="${encoded(id)}">
    ${SLASHES}
    <BehaviorTree ID="${encoded(id)}">
        <Sequence/>
    </BehaviorTree>
    ${SLASHES}
    <TreeNodesModel>
    </TreeNodesModel>
    ${SLASHES}
</root>
`;

/** With another tree behind the last one. */
export function withTree(text: string, id: string): string {
  const root = parse(text);
  const last = root.children.findLastIndex((one) => one.tag === "BehaviorTree");
  return inserted(text, root, last + 1, `<BehaviorTree ID="${encoded(id)}">\n    <Sequence/>\n</BehaviorTree>`);
}

/** With the entry by which Groot knows a node, which it needs of every type that is not its own. */
export function withModel(text: string, type: NodeType | undefined): string {
  if (type === undefined || type.builtin || type.kind === "subtree") {
    return text;
  }
  const root = parse(text);
  const model = root.children.find((one) => one.tag === "TreeNodesModel");
  if (model === undefined) {
    const behind = inserted(text, root, root.children.length, "<TreeNodesModel>\n</TreeNodesModel>");
    return withModel(behind, type);
  }
  const ids = model.children.map((one) => valueIn(one, "ID") ?? "");
  const place = ids.findIndex((id) => id > type.id);
  return ids.includes(type.id) ? text : inserted(text, model, place < 0 ? ids.length : place, type.model);
}

export interface At {
  tree: string; // ID
  path: string;
}

/** The first node that begins on each line of the text. */
export function linesOf(text: string, trees: EditTree[]): Map<number, At> {
  const lines = new Map<number, At>();
  let [line, counted] = [1, 0]; // nodes come in the order of the text
  for (const tree of trees) {
    for (const node of tree.nodes.values()) {
      line += text.slice(counted, node.element.from).split("\n").length - 1;
      counted = node.element.from;
      if (!lines.has(line)) {
        lines.set(line, { tree: tree.id, path: node.path });
      }
    }
  }
  return lines;
}

/** The next node for an arrow key: its parent, its first child, its neighbours. */
export function neighbour(tree: EditTree, path: string, way: "up" | "down" | "left" | "right"): string {
  const parent = parentPath(path);
  const beside = (by: number) => (parent === "" ? "" : `${parent}.${indexIn(path) + by}`);
  const found = { up: parent, down: path === "" ? "0" : `${path}.0`, left: beside(-1), right: beside(1) }[way];
  return tree.nodes.has(found) ? found : path;
}
