// The tree of a run: its nodes by path, and what of it is shown.
import type { Tree } from "../models";

export const STATES = ["idle", "running", "success", "failure"] as const;
export type NodeState = (typeof STATES)[number];

export interface TreeNode {
  path: string;
  index: number; // in the lists of the tree, and in the digits of a run
  name: string;
  type: string;
  kind: string;
  ports: string;
  machine: string; // empty where it names none
  team: string[]; // machines that it and the nodes below it name, in the order of the tree
  label: string; // the goal of a leaf, else a name of its own, else its ports
  template: string; // TEMPLATE:LINE that it comes from, empty for a node of the task itself
  children: TreeNode[];
}

/** The value of a port, empty where the node has none of this name. */
export const port = (ports: string, name: string) => new RegExp(`\\b${name}="([^"]*)"`).exec(ports)?.[1] ?? "";

/** The root, and every node by its path. */
export function nodesOf(tree: Tree): Map<string, TreeNode> {
  const nodes = new Map<string, TreeNode>();
  tree.paths.forEach((path, index) => {
    const [name = "", type = "", kind = "", ports = ""] = [tree.names, tree.types, tree.kinds, tree.ports].map(
      (list) => list[index],
    );
    const goal = [port(ports, "subtask_name"), port(ports, "record_name")].filter(Boolean).join(" ");
    const node: TreeNode = {
      path,
      index,
      name,
      type,
      kind,
      ports,
      machine: port(ports, "model_name"),
      team: [],
      label: name === type ? goal || ports : name,
      template: tree.templates[index] ?? "",
      children: [],
    };
    nodes.set(path, node);
    nodes.get(path.slice(0, path.lastIndexOf(".")))?.children.push(node);
    join(nodes, node);
  });
  return nodes;
}

/** Its machine works in every branch that it is in. */
function join(nodes: Map<string, TreeNode>, { path, machine }: TreeNode) {
  for (let at = path; machine !== ""; at = at.slice(0, at.lastIndexOf("."))) {
    const above = nodes.get(at);
    if (above === undefined || above.team.includes(machine)) {
      return;
    }
    above.team.push(machine);
  }
}

/** Paths of all nodes that a node is in. */
export function above(path: string): string[] {
  const parts = path.split(".");
  return parts.slice(1).map((_, index) => parts.slice(0, index + 1).join("."));
}

/** Nodes in which all of some words occur, in the order of the tree; none for no words. */
export function matching(nodes: Map<string, TreeNode>, words: string): TreeNode[] {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const has = ({ type, name, ports, template, path }: TreeNode) => {
    const text = `${type} ${name} ${ports} ${template} ${path}`.toLowerCase();
    return wanted.every((word) => text.includes(word));
  };
  return wanted.length === 0 ? [] : [...nodes.values()].filter(has);
}

export const stateOf = (node: { index: number }, digits: string): NodeState =>
  STATES[Number(digits[node.index] ?? 0)] ?? "idle";

const SMALL = 40; // nodes of a tree that is shown as a whole

/**
 * Paths of nodes whose children are shown. A large tree follows its run: branches that run, and those that hold a node
 * which runs, are open. What a person has folded or opened stays so.
 */
export function openPaths(nodes: Map<string, TreeNode>, digits: string, byHand: Map<string, boolean>): Set<string> {
  const open = new Set<string>();
  for (const node of nodes.values()) {
    const follows = nodes.size <= SMALL || node.path === "0" || stateOf(node, digits) === "running";
    if (node.children.length > 0 && (byHand.get(node.path) ?? follows)) {
      open.add(node.path);
    }
  }
  return open;
}
