// A node of a tree: its state by a shape and Groot's colour.
import { Handle, type NodeProps, type Node as Placed, Position } from "@xyflow/react";
import { memo } from "react";
import { useTranslation } from "react-i18next";
import type { NodeState, TreeNode } from "./shape";

export interface Facts extends Record<string, unknown> {
  node: TreeNode;
  state: NodeState;
  was: NodeState; // the last state that was not idle
  current: boolean; // the leaf that works or waits
  hidden: number; // children that are folded away
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
  const { node, state, was, current, hidden } = data;
  const before = state === "idle" && was !== "idle" ? ` was-${was}` : "";
  const from = node.template && ` (${t("from_template", { name: node.template })})`;
  return (
    <div
      className={`node ${state}${before}${current ? " current" : ""} ${node.kind}`}
      data-path={node.path}
      data-state={state}
      title={`${node.type} ${node.name} ${node.ports}${from}`}
    >
      <Handle type="target" position={Position.Top} isConnectable={false} />
      {node.template && <span className="from_template" />}
      <strong>
        {node.type}
        {hidden > 0 && ` (+${hidden})`}
      </strong>
      <span className="node_mark" aria-hidden="true">
        {MARKS[state]}
      </span>
      <span className="node_label">{node.machine ? `${node.machine}: ${node.label}` : node.label}</span>
      <Handle type="source" position={Position.Bottom} isConnectable={false} />
    </div>
  );
});
