// A node of a tree: its state by a shape and Groot's colour, its machine by a band and its name.
import type { NodeProps, Node as Placed } from "@xyflow/react";
import { duration } from "old/dom.js";
import { memo } from "react";
import { useTranslation } from "react-i18next";
import type { NodeState, TreeNode } from "./shape";
import type { Spent } from "./spent";

export interface Facts extends Record<string, unknown> {
  node: TreeNode;
  state: NodeState;
  was: NodeState; // the last state that was not idle
  current: boolean; // the leaf that works or waits
  hidden: number; // children that are folded away
  found: boolean; // by a search
  band: number; // of its machine, 0: of none, or of several
  spent: Spent | undefined; // undefined: durations are not shown
}

export type BoxNode = Placed<Facts, "box">;

const MARKS: Record<NodeState, string> = { idle: "", running: "▶", success: "✔", failure: "✖" };
export const WORDS: Record<NodeState, string> = {
  idle: "IDLE",
  running: "RUNNING_NODE",
  success: "SUCCESS",
  failure: "FAILURE",
};

export const NodeBox = memo(function NodeBox({ data }: NodeProps<BoxNode>) {
  const { t } = useTranslation();
  const { node, state, was, current, hidden, found, band, spent } = data;
  const from = node.template && ` (${t("from_template", { name: node.template })})`;
  const classes = [
    "node",
    state,
    state === "idle" && was !== "idle" && `was-${was}`,
    current && "current",
    found && "found",
    spent && `spent spent-${spent.heat}`,
    node.kind,
  ];
  const machine = node.machine || (band > 0 ? node.team[0] : "");
  return (
    <div
      className={classes.filter(Boolean).join(" ")}
      data-path={node.path}
      data-state={state}
      title={`${node.type} ${node.name} ${node.ports}${from}`}
    >
      {node.template && <span className="from_template" />}
      {band > 0 && <span className={`band machine-${band}`} />}
      <strong>
        {node.type}
        {hidden > 0 && ` (+${hidden})`}
      </strong>
      <span className="node_mark" aria-hidden="true">
        {spent ? duration(spent.seconds) : MARKS[state]}
      </span>
      <span className="node_label">{machine ? `${machine}: ${node.label}` : node.label}</span>
    </div>
  );
});
