// What can be done with the nodes of a tree. Each gives the next draft, or null where it cannot be done there.
import type { Draft } from "./draft";
import { copied, inserted, isInside, moved, removed, withAttribute, wrapped } from "./edits";
import { type EditNode, type EditTree, indexIn, parentPath, typeOf, withModel } from "./groot";
import type { Types } from "./palette";
import { parse } from "./xml";

export type Where = "inside" | "before" | "after" | "around";
type Next = Partial<Draft> | null;

/** Where something would come: below which element, as which child; null: there is no room. */
function place(tree: EditTree, node: EditNode | undefined, where: Where, coming: EditNode | null) {
  if (node === undefined) {
    return tree.root === null ? { parent: tree.element, index: 0, path: "0" } : null;
  }
  if (where === "inside") {
    const count = node.children.filter((one) => one !== coming).length;
    const end = { parent: node.element, index: node.children.length, path: `${node.path}.${node.children.length}` };
    return node.room > count ? end : null;
  }
  const parent = tree.nodes.get(parentPath(node.path));
  const count = parent?.children.filter((one) => one !== coming).length ?? 0;
  const index = indexIn(node.path) + (where === "after" ? 1 : 0);
  const room = parent !== undefined && parent.room > count;
  return room ? { parent: parent.element, index, path: `${parent.path}.${index}` } : null;
}

/** Puts a new node, given by its text, beside, into or around another one. Into a leaf is behind it. */
export function add(
  draft: Draft,
  tree: EditTree,
  at: EditNode | undefined,
  where: Where,
  source: string,
  types: Types,
): Next {
  const type = types.get(typeOf(parse(source)));
  const model = (text: string) => withModel(text, type);
  if (where === "around" && at !== undefined) {
    const holds = type?.kind === "control" || type?.kind === "decorator";
    return holds ? { text: model(wrapped(draft.text, at.element, source)), chosen: at.path } : null;
  }
  const found = place(tree, at, where, null) ?? (where === "inside" ? place(tree, at, "after", null) : null);
  return found && { text: model(inserted(draft.text, found.parent, found.index, source)), chosen: found.path };
}

export function remove(draft: Draft, tree: EditTree, node: EditNode): Next {
  const parent = parentPath(node.path);
  const left = (tree.nodes.get(parent)?.children.length ?? 1) - 1;
  const next = left === 0 ? parent : `${parent}.${Math.min(indexIn(node.path), left - 1)}`;
  return { text: removed(draft.text, node.element), chosen: next };
}

export const copy = (draft: Draft, node: EditNode) => copied(draft.text, node.element);

/** Moves a node beside or into another one. */
export function move(draft: Draft, tree: EditTree, node: EditNode, at: EditNode, where: Where): Next {
  const found = isInside(at.element, node.element) ? null : place(tree, at, where, node);
  return found && { text: moved(draft.text, node.element, found.parent, found.index), chosen: pathThen(node, found) };
}

/** Where a moved node is found then: it is gone from among those before its new place, or before a parent of that. */
function pathThen(node: EditNode, to: { path: string }): string {
  const own = parentPath(node.path);
  const parts = to.path.split(".");
  const level = own.split(".").length;
  const passes = to.path.startsWith(`${own}.`) && Number(parts[level]) > indexIn(node.path);
  if (passes) {
    parts[level] = String(Number(parts[level]) - 1);
  }
  return parts.join(".");
}

export type Step = "earlier" | "later" | "out" | "in";

/** One step of a node among its siblings, out of its parent, or into the sibling before it. */
export function step(draft: Draft, tree: EditTree, node: EditNode, way: Step): Next {
  const parent = tree.nodes.get(parentPath(node.path));
  const siblings = parent?.children ?? [];
  const index = indexIn(node.path);
  const steps: Record<Step, [EditNode | undefined, Where]> = {
    earlier: [siblings[index - 1], "before"],
    later: [siblings[index + 1], "after"],
    out: [parent, "after"],
    in: [siblings[index - 1], "inside"],
  };
  const [at, where] = steps[way];
  return at === undefined ? null : move(draft, tree, node, at, where);
}

export const setAttribute = (draft: Draft, node: EditNode, name: string, value: string): Next => ({
  text: withAttribute(draft.text, node.element, name, value === "" ? null : value),
});
