// How the drawn tree differs from the stored one or from another task, as a picture.
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Task } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { BOX } from "../tree/boxes";
import { type Placed, placed } from "../tree/layout";
import { type Change, type DiffNode, difference, differing, everyDifference } from "./difference";
import { type EditBoxNode, MARKS } from "./edit_box";
import { type EditTree, treesOf } from "./groot";
import type { Types } from "./palette";
import { Picture } from "./picture";

interface Props {
  tree: EditTree;
  stored: string; // text, empty: there is none
  first: string; // number of the task that it is compared with at first, empty: the stored one, or the last
  tasks: Task[];
  types: Types;
}

const SHOWN: Change[] = ["added", "removed", "changed"];

export function VersionsView({ tree, stored, first, tasks, types }: Props) {
  const { t } = useTranslation();
  const [other, setOther] = useState(first || (stored === "" ? String(tasks.at(-1)?.id ?? "") : ""));
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
  const [chosen, setChosen] = useState("0");
  const roots = useMemo(() => {
    const trees = treesOf(text, types);
    const old = trees.find((one) => one.id === tree.id) ?? trees[0];
    return difference(old?.root ?? null, tree.root);
  }, [tree, text, types]);
  const open = differing(roots);
  const places = beside(roots, open);
  const boxes = places.map(({ node, x, y }): EditBoxNode => {
    const hidden = open.has(node.path) ? 0 : node.children.length;
    const shown = { ...node.node, path: node.path };
    const data = { node: shown, errors: 0, warnings: 0, change: node.change, hidden, drop: "" };
    return { id: node.path, type: "edit", position: { x, y }, ...BOX, selected: node.path === chosen, data };
  });
  const found = [...everyDifference(roots)].filter((one) => one.change !== "same");
  const count = (change: Change) => `${t(`ed_${change}`)}: ${found.filter((one) => one.change === change).length}`;
  return (
    <>
      <p role="status">{found.length === 0 ? t("equal") : SHOWN.map(count).join(", ")}</p>
      <div className="bar ed_changes">
        {found.map((one) => (
          <button key={one.path} type="button" aria-pressed={one.path === chosen} onClick={() => setChosen(one.path)}>
            {`${MARKS[one.change]} ${one.node.type} ${one.node.label}`}
          </button>
        ))}
      </div>
      <Picture boxes={boxes} places={places} chosen={chosen} label={t("difference")} onChoose={setChosen} />
      <Detail node={found.find((one) => one.path === chosen)} />
    </>
  );
}

/** One tree, or both roots side by side. */
function beside(roots: DiffNode[], open: Set<string>): Placed<DiffNode>[] {
  let right = 0;
  return roots.flatMap((root) => {
    const places = placed(root, open);
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
