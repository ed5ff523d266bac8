// The picture that is drawn on: keys, dragging, and what the check found.
import { type DragEvent, type KeyboardEvent, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { BOX } from "../tree/boxes";
import { placed } from "../tree/layout";
import type { Where } from "./acts";
import { type EditBoxNode, NODES, SOURCE } from "./edit_box";
import type { EditTree } from "./groot";
import { type Act, actOf } from "./keys";
import { Picture } from "./picture";
import { type Check, keyOf } from "./use_check";

interface Props {
  tree: EditTree;
  chosen: string;
  check: Check;
  onChoose: (path: string) => void;
  onAct: (act: Act) => void;
  onDrop: (what: { path: string } | { source: string }, at: string, where: Where) => void;
}

const SIDE = 0.3; // of a box's width: there a dragged node comes beside it

/** The node below the pointer, and on which side of it. */
function under(event: DragEvent): { path: string; where: Where } {
  const box = event.target instanceof Element ? event.target.closest<HTMLElement>("[data-path]") : null;
  if (box === null) {
    return { path: "", where: "inside" };
  }
  const { left, width } = box.getBoundingClientRect();
  const part = (event.clientX - left) / width;
  const where = part < SIDE ? "before" : part > 1 - SIDE ? "after" : "inside";
  return { path: box.dataset.path ?? "", where };
}

export function Canvas({ tree, chosen, check, onChoose, onAct, onDrop }: Props) {
  const { t } = useTranslation();
  const [drop, setDrop] = useState({ path: "", where: "inside" as Where });
  const places = useMemo(() => (tree.root === null ? [] : placed(tree.root, null)), [tree]);
  const boxes = places.map(({ node, x, y }): EditBoxNode => {
    const marks = check.marks.get(keyOf({ tree: tree.id, path: node.path }));
    const [errors, warnings] = [marks?.errors.length ?? 0, marks?.warnings.length ?? 0];
    const here = drop.path === node.path ? drop.where : "";
    const data = { node, errors, warnings, change: "same" as const, hidden: 0, drop: here };
    return { id: node.path, type: "edit", position: { x, y }, ...BOX, selected: node.path === chosen, data };
  });
  const pressed = (event: KeyboardEvent) => {
    const act = actOf(event);
    if (act !== undefined && !(event.target instanceof HTMLButtonElement)) {
      event.preventDefault();
      onAct(act);
    }
  };
  const over = (event: DragEvent) => {
    if (event.dataTransfer.types.includes(NODES) || event.dataTransfer.types.includes(SOURCE)) {
      event.preventDefault();
      const next = under(event);
      setDrop((now) => (now.path === next.path && now.where === next.where ? now : next));
    }
  };
  const dropped = (event: DragEvent) => {
    event.preventDefault();
    const { path, where } = under(event);
    const [moved, source] = [event.dataTransfer.getData(NODES), event.dataTransfer.getData(SOURCE)];
    setDrop({ path: "", where: "inside" });
    onDrop(moved ? { path: moved } : { source }, path, where);
  };
  return (
    <div
      className="ed_canvas"
      id="ed_canvas"
      role="application"
      // biome-ignore lint/a11y/noNoninteractiveTabindex: an application takes keys
      tabIndex={0}
      aria-label={t("ed_canvas")}
      aria-describedby="ed_keys"
      onKeyDown={pressed}
      onDragOver={over}
      onDragLeave={() => setDrop({ path: "", where: "inside" })}
      onDrop={dropped}
    >
      <Picture boxes={boxes} places={places} chosen={chosen} label={t("tree_label")} onChoose={onChoose} />
    </div>
  );
}
