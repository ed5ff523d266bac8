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
      label: name === type ? goal || ports : name,
      template: tree.templates[index] ?? "",
      children: [],
    };
    nodes.set(path, node);
    nodes.get(path.slice(0, path.lastIndexOf(".")))?.children.push(node);
  });
  return nodes;
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
