// History: past runs, their journal, and a slider that replays the tree.
import { at, button, duration, heading, keep, make, part, parts, setBadge, setText, table } from "../dom.js";
import { fillReason, showError } from "../reasons.js";
import { ask } from "../server.js";
import { clock, fieldName, said, t, when } from "../strings.js";
import { TreeView, templateOf, zoomBar } from "../treeview.js";

const PAGE = 1000;
const MAX_EVENTS = 20000; // events that a browser replays
const CODES = { IDLE: 0, RUNNING: 1, SUCCESS: 2, FAILURE: 3 };
let view = null;
let runs = [];
let journal = [];
let cut = false; // the journal has more events
let chosen = null;

export function build(root) {
  const box = make("div", { className: "treebox", tabIndex: 0, role: "region", data: { label: "tree_label" } });
  const slider = make("input", { type: "range", id: "slider", min: 0, max: 0, value: 0, oninput: () => replay(Number(at("slider").value)) });
  root.append(
    heading("history"), make("p", { id: "history_problem", className: "bad", role: "status" }),
    make("p", { id: "none_history", hidden: true, data: { t: "none_history" } }),
    table("list_history", "history", ["task", "started_at", "state", "duration", "reason", "show"]),
    make("section", { id: "past", hidden: true },
      make("h2", { id: "past_title" }), make("ul", { id: "past_values", className: "plain", hidden: true }), make("div", { id: "exports", className: "bar" }),
      make("h3", { data: { t: "receipts" } }), make("ul", { id: "receipts", className: "plain" }),
      make("p", {}, make("label", { className: "wide" }, make("span", { data: { t: "timeline" } }), slider), make("output", { id: "moment" })),
      make("p", { id: "journal_cut", className: "bad" }), make("section", { id: "past_tree" }, zoomBar(() => view), box),
      make("h3", { data: { t: "journal" } }), table("list_events", "journal", ["at_time", "event", "node", "text"])),
  );
  view = new TreeView(box);
  if (chosen !== null) {
    showRun(chosen);
  }
}

export async function load() {
  try {
    runs = await ask("/api/runs?limit=50");
    showError(at("history_problem"), null);
    at("none_history").hidden = runs.length > 0;
    showRuns();
  } catch (error) {
    showError(at("history_problem"), error);
  }
}

function showRuns() {
  keep(at("list_history"), runs, (run) => run.run_id, buildRun, fillRun);
  showValues();
}

export function update() {}

/** The text of a journal's entry: a reason, or plain text. */
const textOf = (event) => (event.reason ? said(event.reason) : event.text);

/** Shows the run of an address, so that a link or a reload finds it again. */
export function open([run]) {
  if (run !== undefined && (run !== chosen || at("past").hidden)) {
    showRun(run);
  }
}

function buildRun(run) {
  return make("tr", {}, ...parts("td", ["task", "started"]), make("td", {}, ...parts("span", ["state"])), ...parts("td", ["duration", "reason"]),
    make("td", {}, button("show", "", () => show(run.run_id), ["show_run", { id: run.run_id }])));
}

function fillRun(row, run) {
  setText(part(row, "task"), `${run.task_id} ${run.description}`);
  setText(part(row, "started"), when(run.started_at));
  setBadge(part(row, "state"), run.state);
  const seconds = run.ended_at && (new Date(run.ended_at) - new Date(run.started_at)) / 1000;
  setText(part(row, "duration"), seconds === null ? "-" : duration(seconds));
  fillReason(part(row, "reason"), run.reason);
  markChosen(row);
}

function show(id) {
  const hash = `#history/${encodeURIComponent(id)}`;
  if (location.hash === hash) {
    showRun(id);
  } else {
    location.hash = hash;
  }
}

/** The further facts of the chosen run that the scheduler has recorded. */
function showValues() {
  const values = Object.entries(runs.find((run) => run.run_id === chosen)?.values ?? {});
  at("past_values").hidden = values.length === 0;
  at("past_values").replaceChildren(...values.map(([name, value]) => make("li", {}, `${fieldName(name)}: ${value}`)));
}

function markChosen(row) {
  row.ariaCurrent = String(row.dataset.key === chosen);
}

async function showRun(id) {
  chosen = id;
  [...at("list_history").children].forEach(markChosen);
  try {
    await readJournal(id);
  } catch (error) {
    showError(at("history_problem"), error);
    return;
  }
  const tree = journal.find((event) => event.kind === "tree");
  at("past").hidden = false;
  setText(at("past_title"), `${t("run")} ${id}`);
  showValues();
  at("exports").replaceChildren(make("span", {}, `${t("export")}:`), ...["json", "csv", "mcap"].map((form) => (
    make("a", { className: "button", href: `/api/runs/${encodeURIComponent(id)}/export?form=${form}`, download: "" }, form.toUpperCase()))));
  const stops = journal.filter((event) => event.kind === "stop");
  at("receipts").replaceChildren(...(stops.length === 0 ? [make("li", {}, t(cut ? "no_receipts_yet" : "no_receipts"))]
    : stops.map((event) => make("li", {}, `${clock(event.stamp)} ${textOf(event)}`))));
  setText(at("journal_cut"), cut ? t("journal_cut", { number: journal.length }) : "");
  at("past_tree").hidden = tree === undefined; // a refused run has none
  if (tree === undefined) {
    view.tree = null; // it belongs to another run
  } else {
    view.show(tree.values);
  }
  at("slider").max = Math.max(0, journal.length - 1);
  at("slider").value = at("slider").max;
  replay(journal.length - 1);
  at("past").scrollIntoView();
}

async function readJournal(id) {
  const found = [];
  let page;
  do {
    const after = found.length > 0 ? found[found.length - 1].number : 0;
    page = await ask(`/api/runs/${encodeURIComponent(id)}/events?after=${after}&limit=${PAGE}`);
    found.push(...page);
  } while (page.length === PAGE && found.length <= MAX_EVENTS);
  journal = found.slice(0, MAX_EVENTS);
  cut = found.length > MAX_EVENTS;
}

/** The old and the new state of a node; journals of releases without reasons have both in their text. */
function changeOf(event) {
  const states = event.reason?.args ?? {};
  return states.old in CODES ? states : / (?<old>[A-Z]+) -> (?<new>[A-Z]+)/.exec(` ${event.text}`)?.groups;
}

/** The tree as it was after event number `index` of the journal. */
function replay(index) {
  const event = journal[index];
  setText(at("moment"), event === undefined ? "" : `${clock(event.stamp)} ${event.node} ${textOf(event)}`);
  const templates = new Map(view.tree?.paths.map((path, number) => [path, templateOf(view.tree, number)]));
  const nearby = journal.slice(Math.max(0, index - 100), index + 1).filter((one) => one.kind !== "tree").reverse();
  keep(at("list_events"), nearby, (one) => one.number, () => make("tr", {}, ...parts("td", ["time", "kind", "node", "text"])), (row, one) => {
    setText(part(row, "time"), clock(one.stamp));
    setText(part(row, "kind"), one.kind);
    const template = templates.get(one.node);
    setText(part(row, "node"), template ? `${one.node} (${t("from_template", { name: template })})` : one.node);
    setText(part(row, "text"), textOf(one));
  });
  if (view.tree === null) {
    return;
  }
  const states = view.tree.paths.map(() => 0);
  const numbers = new Map(view.tree.paths.map((path, number) => [path, number]));
  view.forget();
  let current = "";
  for (const one of journal.slice(0, index + 1)) {
    const change = one.kind === "node" ? changeOf(one) : null;
    if (change && numbers.has(one.node)) {
      states[numbers.get(one.node)] = CODES[change.new];
      view.last.set(one.node, CODES[change.new] || CODES[change.old]);
      current = one.node;
    }
  }
  view.paint(states.join(""), current);
}

export function redraw() {
  showRuns();
  if (view?.tree) {
    view.rebuild();
  }
}
