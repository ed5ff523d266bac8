// The editor of one task or template: picture, palette, form, findings.
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { Findings } from "../findings";
import { Problem } from "../problem";
import type { Where } from "./acts";
import { Bar } from "./bar";
import { Canvas } from "./canvas";
import { isChanged } from "./draft";
import { treesOf, withTree } from "./groot";
import type { Act } from "./keys";
import { groupsOf } from "./palette";
import { PaletteList } from "./palette_list";
import { PortForm } from "./port_form";
import { SaveForm } from "./save_form";
import type { Site, Target } from "./site";
import { Tabs } from "./tabs";
import { useActs } from "./use_acts";
import { type Check, keyOf, useCheck } from "./use_check";
import { keepAt, useDrafts } from "./use_drafts";
import { VersionsView } from "./versions_view";

const ALL: Act[] = ["undo", "redo", "copy", "cut", "paste", "remove", "earlier", "later", "out", "in"];

/** Errors of each tree. */
function wrongIn(check: Check): Map<string, number> {
  const wrong = new Map<string, number>();
  for (const [key, marks] of check.marks) {
    const tree = key.split("\n")[0] ?? "";
    wrong.set(tree, (wrong.get(tree) ?? 0) + marks.errors.length);
  }
  return new Map([...wrong].filter(([, count]) => count > 0));
}

interface Props {
  rest: string; // of the address
  site: Site;
  target: Target;
  other: string; // number of the task to which the difference is open at first, empty: none
  onRecord: () => void; // a record was made
}

export function Editor({ rest, site, target, other, onRecord }: Props) {
  const { t } = useTranslation();
  const [drafts, setDrafts] = useDrafts(rest, target, site);
  const [where, setWhere] = useState<Where>("inside");
  const [comparing, setComparing] = useState(other !== "");
  const { text, chosen } = drafts.now;
  const trees = useMemo(() => treesOf(text, site.types), [text, site]);
  const tree = trees.find((one) => one.id === drafts.now.tree) ?? trees[0];
  const node = tree?.nodes.get(chosen);
  const check = useCheck(text, site.types);
  const { acts, take, put, set, drop } = useActs({ drafts, setDrafts, tree, node, types: site.types });
  const groups = useMemo(() => {
    const others = trees.filter((one) => one !== tree).map((one) => one.id);
    return groupsOf(site.types, site.workers, others, site.templates);
  }, [site, trees, tree]);
  const act = (one: Act) => acts[one]?.();
  const toLine = (line: number) => {
    const at = check.lines.get(line);
    if (at !== undefined) {
      take({ tree: at.tree, chosen: at.path });
    }
  };
  const saved = (next: string) => {
    keepAt(next, rest, drafts);
    setDrafts((now) => ({ ...now, stored: text }));
    location.hash = `#editor/${next}`;
  };
  if (tree === undefined) {
    return <p className="bad">{t("ed_no_tree")}</p>;
  }
  return (
    <>
      <Tabs
        trees={trees}
        shown={tree.id}
        wrong={wrongIn(check)}
        onShow={(id) => take({ tree: id, chosen: "0" })}
        onNew={(id) => take({ text: withTree(text, id), tree: id, chosen: "0" })}
      />
      <Bar cannot={ALL.filter((one) => acts[one] === undefined)} onAct={act} />
      <div className="ed_grid">
        <div>
          <p role="status" className="ed_chosen">
            {node ? t("ed_is_chosen", { node: `${node.type} ${node.machine} ${node.label}`.trim() }) : t("ed_choose")}
          </p>
          {comparing ? (
            <VersionsView tree={tree} stored={drafts.stored} first={other} tasks={site.tasks} types={site.types} />
          ) : (
            <Canvas
              key={tree.id}
              tree={tree}
              chosen={chosen}
              check={check}
              onChoose={(path) => take({ chosen: path })}
              onAct={act}
              onDrop={drop}
            />
          )}
          <button type="button" aria-pressed={comparing} onClick={() => setComparing(!comparing)}>
            {t("difference")}
          </button>
          <details id="ed_keys">
            <summary>{t("ed_keys")}</summary>
            <span>{t("ed_keys_text")}</span>
          </details>
        </div>
        <PaletteList groups={groups} where={where} onWhere={setWhere} onAdd={(source) => put(source, node, where)} />
        <div>
          {node && (
            <PortForm
              key={`${tree.id} ${chosen}`}
              node={node}
              site={site}
              marks={check.marks.get(keyOf({ tree: tree.id, path: chosen }))}
              onSet={set}
              onTree={(id) => take({ tree: id, chosen: "0" })}
              onRecord={onRecord}
            />
          )}
          <section id="ed_findings" aria-label={t("check")} aria-live="polite" aria-busy={!check.fresh}>
            <Problem error={check.error} />
            {check.found && <Findings found={check.found} onLine={toLine} />}
            {check.planning && <p className="small">{t("check_planning")}</p>}
          </section>
          <SaveForm target={target} text={text} changed={isChanged(drafts)} onSaved={saved} />
        </div>
      </div>
    </>
  );
}
