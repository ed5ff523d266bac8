// Run: machines, active runs and tasks to start.
import { at, button, duration, heading, keep, make, number, part, parts, say, setBadge, setText, table } from "../dom.js";
import { cancelRun, rearmMachine } from "../actions.js";
import { buildPlace, fillPlace } from "../places.js";
import { fillReason, once, showError } from "../reasons.js";
import { ask } from "../server.js";
import { stop } from "../stop.js";
import { said, t } from "../strings.js";

let tasks = null;

export function build(root) {
  root.append(
    heading("active"), make("p", { id: "scheduler", className: "bad", hidden: true, data: { t: "scheduler_silent" } }),
    make("div", { className: "one_run" }, make("p", { id: "none_active", data: { t: "none_active" } }), make("ul", { id: "list_active", className: "rows" })),
    heading("tasks"), make("p", { id: "run_problem", className: "bad", role: "status" }),
    make("p", { id: "none_tasks", hidden: true }, make("a", { className: "button", href: "#tasks", data: { t: "none_tasks" } })),
    table("list_tasks", "tasks", ["task", "model", "description", "run"]), make("div", { id: "checked", role: "status" }),
    heading("machines"), make("p", { id: "none_machines", hidden: true, data: { t: "none_machines" } }),
    make("div", { id: "list_machines", className: "cards" }),
    make("section", { id: "shared_places", hidden: true }, heading("shared_places"), make("ul", { id: "place_alarms", className: "rows" }),
      make("ul", { id: "list_places", className: "rows" })),
  );
  tasks = null;
}

export async function load() {
  try {
    tasks = await ask("/api/tasks");
    showError(at("run_problem"), null);
  } catch (error) {
    showError(at("run_problem"), error);
  }
  if (tasks !== null && at("list_tasks") !== null) {
    at("none_tasks").hidden = tasks.length > 0;
    keep(at("list_tasks"), tasks, (task) => task.id, buildTask, fillTask);
  }
}

export function update(state) {
  at("scheduler").hidden = state.scheduler.alive;
  at("none_active").hidden = state.runs.length > 0;
  keep(at("list_active"), state.runs, (run) => run.run_id, buildActive, fillActive);
  at("none_machines").hidden = state.machines.length > 0;
  keep(at("list_machines"), state.machines, (machine) => machine.name, buildMachine, fillMachine);
  at("shared_places").hidden = state.shared.places.length === 0;
  keep(at("place_alarms"), state.shared.alarms, (alarm) => said(alarm), () => make("li"), fillReason);
  keep(at("list_places"), state.shared.places, (place) => place.name, buildPlace, fillPlace);
}

// runs

function buildActive(run) {
  const cancel = (event) => once(event.currentTarget, () => cancelRun(run.run_id));
  const link = make("a", { className: "button", href: `#tree/${encodeURIComponent(run.run_id)}`, data: { t: "p_tree" } }, t("p_tree"));
  return make("li", {}, ...parts("strong", ["task"]), ...parts("span", ["state", "machines", "reason"]), link,
    button("cancel", "stop", cancel, ["cancel_run", { id: run.run_id }]));
}

function fillActive(row, run) {
  setText(part(row, "task"), `${t("task")} ${run.task_id}`);
  setBadge(part(row, "state"), run.state);
  setText(part(row, "machines"), run.machines.join(", "));
  fillReason(part(row, "reason"), run.reason, { done: "cancel" });
}

// tasks

function buildTask(task) {
  const start = (event) => once(event.currentTarget, async () => {
    say(t("starting", { id: task.id }));
    const answer = await ask("/api/runs", { task_id: task.id });
    return t("started", { id: answer.run_id });
  });
  const check = (event) => once(event.currentTarget, () => checkTask(task.id));
  return make("tr", {}, ...parts("td", ["id", "model", "description"]), make("td", { className: "bar" },
    button("run", "go", start, ["run_task", { id: task.id }]), button("check", "", check, ["check_task", { id: task.id }])));
}

function fillTask(row, task) {
  setText(part(row, "id"), String(task.id));
  setText(part(row, "model"), task.model_name);
  setText(part(row, "description"), task.description);
}

async function checkTask(id) {
  const found = await ask("/api/tasks/check", { xml: (await ask(`/api/tasks/${id}`)).xml });
  showFindings(at("checked"), found);
}

/** Shows the findings of a check with their lines. */
export function showFindings(box, found) {
  box.replaceChildren();
  if (found.errors.length + found.warnings.length === 0) {
    box.append(make("p", { className: "good" }, t("check_good")));
  }
  for (const kind of ["errors", "warnings"]) {
    if (found[kind].length > 0) {
      box.append(make("h3", {}, `${t(kind)} (${found[kind].length})`), make("ul", { className: kind },
        ...found[kind].map(buildFinding)));
    }
  }
}

function buildFinding({ line, reason }) {
  const row = make("li", { data: { line: line ?? "" } });
  fillReason(row, reason, { done: "edit_task" }); // the text of the task is on the screen
  return row;
}

// machines

function buildMachine(machine) {
  const name = machine.name;
  const rearm = (event) => once(event.currentTarget, () => rearmMachine(name));
  const head = make("tr", {}, ...["joint", "angle_rad", "angle_deg"].map((key) => make("th", { scope: "col", data: { t: key } }, t(key))));
  const again = button("rearm", "go", rearm, ["rearm_machine", { name }]);
  again.dataset.part = "rearm";
  return make("article", { className: "card", data: { machine: name } }, ...parts("h3", ["name"]), ...parts("span", ["state", "armed"]),
    ...parts("p", ["by_hand", "latch", "reason", "hold", "goal", "age"]),
    make("div", { className: "bar" }, again, button("stop_one", "stop", () => stop(name), ["stop_machine", { name }])),
    make("table", {}, make("thead", {}, head), make("tbody", { data: { part: "joints" } })));
}

function fillMachine(card, machine) {
  setText(part(card, "name"), machine.name);
  setBadge(part(card, "state"), machine.state);
  setBadge(part(card, "armed"), machine.by_hand ? "by_hand" : machine.latch ? "latched" : machine.hold ? "held" : "armed");
  part(card, "armed").hidden = machine.state === "silent";
  setText(part(card, "by_hand"), machine.by_hand ? t("who_drives", { name: machine.by_hand }) : "");
  const latch = machine.latch ? t("why_latched", { cause: said(machine.latch) }) : "";
  fillReason(part(card, "latch"), machine.latch, { text: latch, done: "rearm" }); // the card has this button
  fillReason(part(card, "hold"), machine.hold);
  fillReason(part(card, "reason"), machine.reason, { done: "rearm" });
  setText(part(card, "goal"), machine.goal ? `${t("goal")}: ${machine.owner}` : "");
  setText(part(card, "age"), `${t("data_age")}: ${duration(machine.joint_age)}`);
  part(card, "rearm").hidden = !machine.latch;
  keep(part(card, "joints"), machine.joints, (joint) => joint.name,
    () => make("tr", {}, ...parts("td", ["joint", "rad", "deg"])), (row, joint) => {
      setText(part(row, "joint"), joint.name);
      setText(part(row, "rad"), number(joint.position, 3));
      setText(part(row, "deg"), number((joint.position * 180) / Math.PI, 1));
    });
}
