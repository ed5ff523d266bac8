// A node on the picture of the editor: what the check found at it, and how it differs from another version.
import type { NodeProps, Node as Placed } from "@xyflow/react";
import { memo } from "react";
import type { Change } from "./difference";
import type { EditNode } from "./groot";

export interface Facts extends Record<string, unknown> {
  node: EditNode;
  errors: number;
  warnings: number;
  change: Change;
  hidden: number; // children that are folded away
  drop: string; // where a dragged node would come: before, inside, after; empty: not here
}

export type EditBoxNode = Placed<Facts, "edit">;

export const NODES = "application/x-tms-node"; // what is dragged: the path of a node ...
export const SOURCE = "application/x-tms-source"; // ... or the text of a new one

export const MARKS: Record<Change, string> = { same: "", added: "+", removed: "−", changed: "~" };

export const EditBox = memo(function EditBox({ data, selected }: NodeProps<EditBoxNode>) {
  const { node, errors, warnings, change, hidden, drop } = data;
  const classes = ["node", node.kind, selected && "current", errors > 0 && "failure", change, drop && `drop_${drop}`];
  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: keys and buttons do what dragging does
    <div
      className={classes.filter(Boolean).join(" ")}
      data-path={node.path}
      data-change={change}
      title={node.element.attributes.map((one) => `${one.name}="${one.value}"`).join("\n")}
      draggable
      onDragStart={(event) => event.dataTransfer.setData(NODES, node.path)}
    >
      <strong>
        {node.type}
        {hidden > 0 && ` (+${hidden})`}
      </strong>
      <span className="node_mark">
        {MARKS[change]}
        {errors > 0 && ` ✖${errors}`}
        {warnings > 0 && ` ▲${warnings}`}
      </span>
      <span className="node_label">{node.machine ? `${node.machine}: ${node.label}` : node.label}</span>
    </div>
  );
});
