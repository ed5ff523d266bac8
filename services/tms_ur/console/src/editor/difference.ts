// What differs between two versions of a tree, node by node.
import { type EditNode, parentPath } from "./groot";

export type Change = "same" | "added" | "removed" | "changed";

export interface DiffNode {
  path: string;
  node: EditNode;
  before: EditNode | null; // of a changed node
  change: Change;
  children: DiffNode[];
}

const own = (node: EditNode) =>
  node.type +
  node.element.attributes
    .filter((one) => one.name !== "ID")
    .map((one) => `\n${one.name}=${one.value}`)
    .sort()
    .join("");

/** All that a node and those below it say, whatever the order of attributes, blanks and comments. */
function said(node: EditNode, known: Map<EditNode, string>): string {
  const text = known.get(node) ?? `(${own(node)}${node.children.map((child) => said(child, known)).join("")})`;
  known.set(node, text);
  return text;
}

type Pair = [EditNode | null, EditNode | null];

/** Children of both versions side by side, in their order, so that as much as can be is alike. */
function paired(old: EditNode[], now: EditNode[], known: Map<EditNode, string>): Pair[] {
  const alike = (a: EditNode, b: EditNode) =>
    said(a, known) === said(b, known) ? 4 : own(a) === own(b) ? 3 : a.type === b.type ? 1 : 0;
  const best = Array.from({ length: old.length + 1 }, () => new Array<number>(now.length + 1).fill(0));
  const value = (i: number, j: number) => best[i]?.[j] ?? 0;
  for (let i = old.length - 1; i >= 0; i -= 1) {
    for (let j = now.length - 1; j >= 0; j -= 1) {
      const both = alike(old[i] as EditNode, now[j] as EditNode);
      const found = Math.max(value(i + 1, j), value(i, j + 1), both > 0 ? both + value(i + 1, j + 1) : 0);
      (best[i] as number[])[j] = found;
    }
  }
  const pairs: Pair[] = [];
  let [i, j] = [0, 0];
  while (i < old.length || j < now.length) {
    const [a, b] = [old[i] ?? null, now[j] ?? null];
    const both = a && b ? alike(a, b) : 0;
    if (both > 0 && value(i, j) === both + value(i + 1, j + 1)) {
      pairs.push([a, b]);
      [i, j] = [i + 1, j + 1];
    } else if (a && (!b || value(i + 1, j) >= value(i, j + 1))) {
      pairs.push([a, null]);
      i += 1;
    } else {
      pairs.push([null, b]);
      j += 1;
    }
  }
  return pairs;
}

/** Both versions of the trees below two roots as one tree, or two where the roots have nothing in common. */
export function difference(old: EditNode | null, now: EditNode | null): DiffNode[] {
  const known = new Map<EditNode, string>();
  const build = (pairs: Pair[], path: string): DiffNode[] =>
    pairs.flatMap(([a, b], index) => {
      const node = b ?? a;
      if (node === null) {
        return [];
      }
      const change = a === null ? "added" : b === null ? "removed" : own(a) === own(b) ? "same" : "changed";
      const here = path === "" ? String(index) : `${path}.${index}`;
      const below = paired(a?.children ?? [], b?.children ?? [], known);
      return [{ path: here, node, before: change === "changed" ? a : null, change, children: build(below, here) }];
    });
  return build(paired(old ? [old] : [], now ? [now] : [], known), "");
}

/** Paths of nodes below which something differs, and of the roots: all else can be folded. */
export function differing(nodes: DiffNode[]): Set<string> {
  const paths = new Set(nodes.map((one) => one.path));
  for (const one of everyDifference(nodes)) {
    for (let path = one.change === "same" ? "" : one.path; path !== ""; path = parentPath(path)) {
      paths.add(parentPath(path));
    }
  }
  paths.delete("");
  return paths;
}

export function* everyDifference(nodes: DiffNode[]): Generator<DiffNode> {
  for (const one of nodes) {
    yield one;
    yield* everyDifference(one.children);
  }
}
