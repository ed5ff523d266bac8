// The live tree of a run, and one sentence with the reason of its present state.

import { siteNow, treeOf, treeProblem } from "old/server.js";
import { useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { useJournal } from "../journal/use_journal";
import { useLive } from "../live";
import type { ActiveRun, State, Tree } from "../models";
import { Problem } from "../problem";
import { Said } from "../said";
import { said, timeOfDay } from "../texts";
import { TreeFlow } from "./flow";
import { LiveFacts } from "./live_facts";
import type { TreeNode } from "./shape";
import { spentIn } from "./spent";
import { useLast } from "./use_last";

interface Shown {
  id: string;
  tree: Tree;
  digits: string;
  leaf: string;
}

export default function TreePage({ rest }: { rest: string }) {
  const { t } = useTranslation();
  const { state } = useLive();
  const shown = useRef<Shown | null>(null); // the last tree stays on the screen
  const chosen = useRef(rest);
  chosen.current = rest || chosen.current;
  const run = state?.runs.find((one) => one.run_id === decodeURIComponent(chosen.current)) ?? state?.runs[0];
  const tree = run === undefined ? null : treeOf(run.run_id);
  if (run !== undefined && tree !== null) {
    shown.current = { id: run.run_id, tree, digits: run.nodes, leaf: run.leaf };
  }
  const last = useLast(shown.current?.id ?? "", shown.current?.digits ?? "");
  const id = shown.current?.id ?? "";
  const facts = (node: TreeNode) => <LiveFacts key={`${id} ${node.path}`} run={id} node={node} />;
  const alive = state?.scheduler.alive ?? true;
  const timing = useTiming(id, run !== undefined);
  return (
    <>
      <h2>{t("p_tree")}</h2>
      <section id="tree_runs" className="bar" aria-label={t("choose_run")}>
        {state?.runs.map((one) => (
          <a
            key={one.run_id}
            className="button"
            href={`#tree/${encodeURIComponent(one.run_id)}`}
            aria-current={one === run ? "true" : "false"}
          >
            {t("task")} {one.task_id} ({one.machines.join(", ") || "-"})
          </a>
        ))}
      </section>
      {run === undefined && (!alive || shown.current === null) && (
        <p id="no_tree">{t(alive ? "no_tree" : "scheduler_silent")}</p>
      )}
      {state && run && <Why run={run} state={state} />}
      {run && tree === null && <Problem id="tree_problem" what={t("no_shape")} error={treeProblem(run.run_id)} />}
      {shown.current && (
        <TreeFlow key={shown.current.id} {...shown.current} last={last} facts={facts} timing={timing} />
      )}
    </>
  );
}

/** How long the nodes of a run took; its journal is read only while that is shown. */
function useTiming(id: string, live: boolean) {
  const [shown, setShown] = useState(false);
  const { journal } = useJournal(shown ? id : "", live);
  const spent = useMemo(() => journal && spentIn(journal, journal.events.length, siteNow()), [journal]);
  return { shown, spent, onShow: setShown };
}

/** Why it does not move on, or what it does. */
function Why({ run, state }: { run: ActiveRun; state: State }) {
  const { t } = useTranslation();
  const moving = state.machines.some((machine) => run.machines.includes(machine.name) && machine.state === "moving");
  const { alive } = state.scheduler;
  const since = run.reason_since ? ` (${t("since", { time: timeOfDay(run.reason_since, siteNow()) })})` : "";
  const going = t(run.state === "running" ? "moving_on" : run.state);
  const text = alive ? (run.reason ? said(run.reason) + since : going) : t("scheduler_silent");
  return (
    <div id="tree_why" className="why" role="status">
      <span id="tree_state">
        <Badge state={alive ? run.state : "UNKNOWN"} />
      </span>{" "}
      <strong id="tree_why_head">{t(moving ? "doing" : "why")}</strong>:{" "}
      <span id="tree_reason">
        <Said reason={alive ? run.reason : null} text={text} />
      </span>
    </div>
  );
}
