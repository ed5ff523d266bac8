// How the drawn tree differs from the stored one or from another task, as a picture.
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Task } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { BOX } from "../tree/boxes";
import { type Placed, placed } from "../tree/layout";
import { type Change, type DiffNode, difference, everyDifference } from "./difference";
import type { EditBoxNode } from "./edit_box";
import { type EditTree, treesOf } from "./groot";
import type { Types } from "./palette";
import { Picture } from "./picture";

interface Props {
  tree: EditTree;
  stored: string; // text, empty: there is none
  tasks: Task[];
  types: Types;
}

const SHOWN: Change[] = ["added", "removed", "changed"];

export function VersionsView({ tree, stored, tasks, types }: Props) {
  const { t } = useTranslation();
  const [other, setOther] = useState(stored === "" ? String(tasks.at(-1)?.id ?? "") : "");
  const [text, setText] = useState(stored);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    if (other === "") {
      setText(stored);
      return;
    }
    let left = false;
    get("/api/tasks/{task_id}", { task_id: other }).then(
      (task) => {
        if (!left) {
          setText(task.xml);
          setError(null);
        }
      },
      (why: Error) => left || setError(why),
    );
    return () => {
      left = true;
    };
  }, [other, stored]);
  return (
    <section aria-label={t("difference")}>
      <label>
        {t("compare")}
        <select value={other} onChange={(event) => setOther(event.target.value)}>
          {stored !== "" && <option value="">{t("ed_as_stored")}</option>}
          {tasks.map((task) => (
            <option key={task.id} value={task.id}>{`${task.id} ${task.description}`}</option>
          ))}
        </select>
      </label>
      <Problem error={error} />
      {text !== "" && <Drawn tree={tree} text={text} types={types} />}
    </section>
  );
}

function Drawn({ tree, text, types }: { tree: EditTree; text: string; types: Types }) {
  const { t } = useTranslation();
  const [chosen, setChosen] = useState("");
  const trees = treesOf(text, types);
  const old = trees.find((one) => one.id === tree.id) ?? trees[0];
  const roots = difference(old?.root ?? null, tree.root);
  const all = [...everyDifference(roots)];
  const places = beside(roots);
  const boxes = places.map(({ node, x, y }): EditBoxNode => {
    const data = { node: { ...node.node, path: node.path }, errors: 0, warnings: 0, change: node.change, drop: "" };
    return { id: node.path, type: "edit", position: { x, y }, ...BOX, selected: node.path === chosen, data };
  });
  return (
    <>
      <p role="status">
        {all.every((one) => one.change === "same")
          ? t("equal")
          : SHOWN.map((change) => `${t(`ed_${change}`)}: ${all.filter((one) => one.change === change).length}`).join(
              ", ",
            )}
      </p>
      <Picture boxes={boxes} places={places} chosen={chosen} label={t("difference")} onChoose={setChosen} />
      <Detail node={all.find((one) => one.path === chosen)} />
    </>
  );
}

/** One tree, or both roots side by side. */
function beside(roots: DiffNode[]): Placed<DiffNode>[] {
  let right = 0;
  return roots.flatMap((root) => {
    const places = placed(root, null);
    const left = Math.min(...places.map((one) => one.x));
    const moved = places.map((one) => ({ ...one, x: one.x - left + right }));
    right = Math.max(...moved.map((one) => one.x)) + 2 * BOX.width;
    return moved;
  });
}

/** What a changed node says now, and what it said. */
function Detail({ node }: { node: DiffNode | undefined }) {
  if (node?.before == null) {
    return null;
  }
  const said = (one: typeof node.node) =>
    one.element.attributes.map(({ name, value }) => `${name}="${value}"`).join(" ");
  return (
    <pre>
      <span className="removed">{`- ${said(node.before)}\n`}</span>
      <span className="added">{`+ ${said(node.node)}`}</span>
    </pre>
  );
}
