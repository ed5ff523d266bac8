// The panel of one task: a green start that asks once, a red software stop, and the questions of the run.
import { askInDialog, prepareDialog } from "./confirm.js";
import { at, keep, make, relabelAll, setText } from "./dom.js";
import { buildQuestion, fillQuestion } from "./questions.js";
import { ask, watch } from "./server.js";
import { fillReason, once, sayError } from "./reasons.js";
import { reportOpen, stop } from "./stop.js";
import { onLanguage, said, switchLanguage, t, translatePage } from "./strings.js";

const id = Number(new URLSearchParams(location.search).get("task"));
let task = null;
let state = null;

function heard(now) {
  state = now;
  const run = now.runs.find((one) => one.task_id === id);
  keep(at("questions"), now.questions.filter((one) => one.run_id === run?.run_id), (one) => one.id, buildQuestion, fillQuestion);
  const latched = now.machines.filter((machine) => machine.latch);
  const stopped = latched.map((machine) => `${machine.name}: ${t("why_latched", { cause: said(machine.latch) })}`).join(" ");
  setText(at("machines"), stopped);
  at("machines").className = stopped ? "bad" : "";
  const reason = now.scheduler.alive ? run?.reason : null;
  fillReason(at("state"), reason, { text: now.scheduler.alive ? tellState(run) : t("scheduler_silent") });
  at("start").disabled = run !== undefined;
}

function tellState(run) {
  return run ? `${t(run.state)}: ${said(run.reason) || t(run.state === "running" ? "moving_on" : run.state)}` : t("panel_ready");
}

function name() {
  setText(at("task"), id ? `${t("task")} ${id} ${task?.description ?? ""}` : t("panel_none"));
}

/** The task and the machines that will move. */
function whatStarts(machines) {
  const named = `${id} ${task?.description ?? ""}`.trim();
  return [
    make("p", {}, t(machines.length > 0 ? "start_ask" : "start_ask_none", { task: named })),
    make("ul", { id: "will_move", className: "plain" }, ...machines.map((one) => make("li", {}, make("strong", {}, one)))),
  ];
}

async function load() {
  try {
    task = await ask(`/api/tasks/${id}`);
  } catch (error) {
    sayError(error);
  }
  name();
}

at("start").addEventListener("click", (event) => once(event.currentTarget, async () => {
  const { machines } = await ask(`/api/tasks/${id}/machines`);
  if (!(await askInDialog(...whatStarts(machines)))) {
    return "";
  }
  const answer = await ask("/api/runs", { task_id: id });
  return t("started", { id: answer.run_id });
}));
at("stop").addEventListener("click", () => stop());
at("language").addEventListener("click", switchLanguage);
onLanguage(() => {
  relabelAll();
  name();
  if (state !== null) {
    heard(state);
  }
});
translatePage();
prepareDialog();
name();

ask("/api/session").then((session) => {
  if (session.name === null) {
    location.href = `/?panel=${id}`; // log in there first
    return;
  }
  document.body.dataset.role = session.role ?? "";
  reportOpen(session);
  load();
  watch(heard, (there) => {
    at("connecting").hidden = there !== null;
    at("lost").hidden = there !== false;
    document.body.classList.toggle("old", !there);
  });
}, sayError);
