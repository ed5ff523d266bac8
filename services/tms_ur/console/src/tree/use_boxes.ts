// The boxes of a tree. One that is as before is the same object: what has not changed is not drawn again.
import { useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import { BOX } from "./boxes";
import type { Placed } from "./layout";
import { type BoxNode, type Facts, WORDS } from "./node_box";
import { type NodeState, stateOf, type TreeNode } from "./shape";
import type { Spent } from "./spent";

export interface Looks {
  digits: string; // state of every node
  leaf: string; // path of the one that works or waits
  last: Map<number, NodeState>; // of each node by its index: the last state that was not idle
  chosen: string; // path
  open: Set<string>; // paths of nodes whose children are shown
  found: Set<string>; // paths of nodes that were searched for
  machines: string[]; // all of the tree
  spent: Map<number, Spent> | null; // null: durations are not shown
}

const BANDS = 6; // colours of machines
const NEVER: Spent = { seconds: 0, heat: 0 };

/** The number of a machine's colour; 0 where it is none, or several. */
export const bandOf = (team: string[], machines: string[]) =>
  team.length === 1 ? 1 + (machines.indexOf(team[0] ?? "") % BANDS) : 0;

function factsOf(node: TreeNode, looks: Looks): Facts {
  const { digits, leaf, last, open, found, machines, spent } = looks;
  return {
    node,
    state: stateOf(node, digits),
    was: last.get(node.index) ?? "idle",
    current: node.path === leaf,
    hidden: open.has(node.path) ? 0 : node.children.length,
    found: found.has(node.path),
    band: machines.length > 1 ? bandOf(node.team, machines) : 0,
    spent: spent === null ? undefined : (spent.get(node.index) ?? NEVER),
  };
}

const same = (one: Facts, other: Facts) =>
  Object.keys(one).every((key) => key === "spent" || one[key] === other[key]) &&
  one.spent?.seconds === other.spent?.seconds &&
  one.spent?.heat === other.spent?.heat;

export function useBoxes(places: Placed<TreeNode>[], looks: Looks): BoxNode[] {
  const { t } = useTranslation();
  const kept = useRef(new Map<string, BoxNode>());
  const { digits, leaf, last, chosen, open, found, machines, spent } = looks;
  // biome-ignore lint/correctness/useExhaustiveDependencies: these are what `looks` holds
  return useMemo(() => {
    const now = new Map<string, BoxNode>();
    for (const { node, x, y } of places) {
      const data = factsOf(node, looks);
      const before = kept.current.get(node.path);
      const ariaLabel = `${node.type} ${node.name}: ${t(WORDS[data.state])}`;
      const stays =
        before !== undefined &&
        before.position.x === x &&
        before.position.y === y &&
        before.selected === (node.path === chosen) &&
        before.ariaLabel === ariaLabel &&
        same(before.data, data);
      const made = { id: node.path, type: "box" as const, position: { x, y }, ...BOX, ariaLabel, data };
      now.set(node.path, stays ? before : { ...made, selected: node.path === chosen });
    }
    kept.current = now;
    return [...now.values()];
  }, [places, digits, leaf, last, chosen, open, found, machines, spent, t]);
}
