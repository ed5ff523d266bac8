// Tree: the live tree of a run, and one sentence with the reason of its present state.
import { at, button, heading, keep, make, setBadge, setText } from "../dom.js";
import { fillReason } from "../reasons.js";
import { treeOf } from "../server.js";
import { said, t } from "../strings.js";
import { TreeView } from "../treeview.js";

let view = null;
let chosen = null; // run that a link asked for
let states = "";

export function build(root) {
  const box = make("div", { id: "tree_box", className: "treebox", tabIndex: 0, role: "region", data: { label: "tree_label" } });
  root.append(
    heading("p_tree"), make("div", { id: "tree_runs", className: "bar", role: "group", data: { label: "choose_run" } }),
    make("p", { id: "no_tree", data: { t: "no_tree" } }),
    make("div", { id: "tree_why", className: "why", role: "status", hidden: true }, make("span", { id: "tree_state" }), " ",
      make("strong", { id: "tree_why_head" }), ": ", make("span", { id: "tree_reason" })),
    zoomBar(() => view), box,
  );
  view = new TreeView(box);
}

/** Buttons for a view. */
export function zoomBar(find) {
  return make("div", { className: "bar" }, button("zoom_in", "", () => find().step(1)), button("zoom_out", "", () => find().step(-1)),
    button("fit", "", () => find().fit()), button("expand", "", () => find().openAll()));
}

export function open([run]) {
  chosen = run ?? chosen;
}

export function update(state) {
  const run = state.runs.find((one) => one.run_id === chosen) ?? state.runs[0];
  keep(at("tree_runs"), state.runs, (one) => one.run_id,
    (one) => make("a", { className: "button", href: `#tree/${encodeURIComponent(one.run_id)}` }),
    (link, one) => {
      setText(link, `${t("task")} ${one.task_id} (${one.machines.join(", ") || "-"})`);
      link.ariaCurrent = one === run ? "true" : "false";
    });
  const tree = run === undefined ? null : treeOf(run.run_id);
  const { alive } = state.scheduler;
  at("no_tree").hidden = run !== undefined || (alive && view.tree !== null);
  setText(at("no_tree"), t(alive ? "no_tree" : "scheduler_silent"));
  at("tree_why").hidden = run === undefined;
  if (run !== undefined) {
    const moving = state.machines.some((machine) => run.machines.includes(machine.name) && machine.state === "moving");
    setText(at("tree_why_head"), t(moving ? "doing" : "why"));
    setBadge(at("tree_state"), alive ? run.state : "UNKNOWN");
    const text = !alive ? t("scheduler_silent") : said(run.reason) || t(run.state === "running" ? "moving_on" : run.state);
    fillReason(at("tree_reason"), alive ? run.reason : null, { text });
  }
  if (tree === null) {
    return; // the last tree stays on the screen
  }
  view.show(tree);
  if (states !== run.nodes || view.current !== run.leaf) {
    states = run.nodes;
    view.paint(run.nodes, run.leaf);
  }
}

export function redraw() {
  if (view?.tree) {
    view.rebuild();
  }
}
