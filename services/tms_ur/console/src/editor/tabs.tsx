// The trees of a task, and the templates that it calls.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { type EditTree, typeOf } from "./groot";
import { CALL } from "./palette";
import { valueIn } from "./xml";

interface Props {
  trees: EditTree[];
  shown: string; // ID
  wrong: Map<string, number>; // errors by tree
  onShow: (id: string) => void;
  onNew: (id: string) => void;
}

/** The names of the templates that a task calls. */
export function calledBy(trees: EditTree[]): string[] {
  const nodes = trees.flatMap((tree) => [...tree.nodes.values()]);
  const calls = nodes.filter((node) => typeOf(node.element) === CALL);
  return [...new Set(calls.map((node) => valueIn(node.element, "subtask_name") ?? "").filter(Boolean))];
}

export function Tabs({ trees, shown, wrong, onShow, onNew }: Props) {
  const { t } = useTranslation();
  const [name, setName] = useState("");
  const taken = trees.some((tree) => tree.id === name.trim());
  return (
    <div className="bar ed_tabs">
      {trees.map((tree) => (
        <button key={tree.id} type="button" aria-pressed={tree.id === shown} onClick={() => onShow(tree.id)}>
          {tree.id}
          {wrong.has(tree.id) && ` ✖${wrong.get(tree.id)}`}
        </button>
      ))}
      {calledBy(trees).map((one) => (
        <a key={one} className="button" href={`#editor/template/${encodeURIComponent(one)}`}>
          {t("from_template", { name: one })}
        </a>
      ))}
      <form
        className="bar"
        onSubmit={(event) => {
          event.preventDefault();
          onNew(name.trim());
          setName("");
        }}
      >
        <input
          aria-label={t("ed_tree_name")}
          placeholder={t("ed_tree_name")}
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
        <button type="submit" disabled={name.trim() === "" || taken}>
          {t("ed_new_tree")}
        </button>
      </form>
    </div>
  );
}
