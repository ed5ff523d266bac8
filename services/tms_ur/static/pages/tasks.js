// Tasks: a file from Groot is checked, compared and stored here.
import { at, button, confirmed, heading, keep, make, part, parts, say, setText, table } from "../dom.js";
import { showFindings } from "../findings.js";
import { once, showError } from "../reasons.js";
import { ask } from "../server.js";
import { t, when } from "../strings.js";

const MAX_BYTES = 5_000_000; // same limit as in the server
const MAX_LINES = 2000; // lines that are shown
const MAX_WIDE = 500; // characters of a line
let given = null; // { name, xml } of the chosen file
let found = null; // its check
let stored = [];
let templates = [];

export function build(root) {
  const file = make("input", { type: "file", id: "file", accept: ".xml,text/xml", onchange: read, onclick: () => { at("file").value = ""; } });
  const compare = make("select", { id: "compare", onchange: (event) => once(event.currentTarget, showDifference) });
  const store = button("store", "go", (event) => once(event.currentTarget, storeTask));
  store.id = "store";
  root.append(
    heading("upload"), make("label", {}, make("span", { data: { t: "upload" } }), file), make("div", { id: "findings", role: "status" }),
    make("section", { id: "chosen", hidden: true },
      button("check_again", "", (event) => once(event.currentTarget, checkAgain)),
      make("label", {}, make("span", { data: { t: "description" } }), make("input", { id: "description", maxLength: 1000 })), store,
      button("store_template", "", (event) => once(event.currentTarget, storeTemplate)),
      make("label", {}, make("span", { data: { t: "compare" } }), compare), make("pre", { id: "difference", tabIndex: 0, hidden: true }),
      heading("file_text", "h3"), make("ol", { id: "source", className: "source", tabIndex: 0 })),
    heading("tasks"), make("p", { id: "tasks_problem", className: "bad", role: "status" }),
    make("p", { id: "none_stored", hidden: true, data: { t: "none_tasks_here" } }),
    table("list_stored", "tasks", ["task", "model", "description", "added_at", "commands"]),
    heading("templates"), make("p", { id: "no_templates", hidden: true, data: { t: "none_templates" } }),
    table("list_templates", "templates", ["name", "model", "description", "added_at"]),
  );
  given = found = null;
}

export async function load() {
  try {
    stored = await ask("/api/tasks");
    templates = await ask("/api/templates");
    showError(at("tasks_problem"), null);
  } catch (error) {
    showError(at("tasks_problem"), error);
    return;
  }
  if (at("compare") === null) {
    return;
  }
  at("none_stored").hidden = stored.length > 0;
  keep(at("list_stored"), stored, (task) => task.id, buildTask, fillTask);
  at("no_templates").hidden = templates.length > 0;
  keep(at("list_templates"), templates, (one) => one.name,
    () => make("tr", {}, ...parts("td", ["name", "model", "description", "added"])), fillTemplate);
  keep(at("compare"), [{ id: "" }, ...stored], (task) => task.id, (task) => make("option", { value: task.id }),
    (option, task) => setText(option, task.id === "" ? "-" : `${task.id} ${task.description}`));
}

export function update() {}

// the file

async function read() {
  const file = at("file").files[0];
  if (file === undefined) {
    return;
  }
  say("");
  given = found = null;
  at("chosen").hidden = true;
  if (file.size > MAX_BYTES) {
    at("findings").replaceChildren(make("p", { className: "bad" }, t("too_large", { name: file.name })));
    return;
  }
  given = { name: file.name, xml: await file.text() };
  at("chosen").hidden = false;
  await checkAgain();
}

async function checkAgain() {
  try {
    found = await ask("/api/tasks/check", { xml: given.xml });
    showFindings(at("findings"), found);
  } catch (error) {
    found = null;
    const box = make("p", { className: "bad" });
    showError(box, error);
    at("findings").replaceChildren(box);
  }
  const bad = new Set(found?.errors.map((one) => one.line) ?? []);
  const warned = new Set(found?.warnings.map((one) => one.line) ?? []);
  at("store").disabled = found === null; // the file cannot be read
  at("source").replaceChildren(...given.xml.split("\n", MAX_LINES).map((line, index) => (
    make("li", { className: bad.has(index + 1) ? "errors" : warned.has(index + 1) ? "warnings" : "" }, line.slice(0, MAX_WIDE) || " "))));
  return showDifference();
}

async function storeTask() {
  if (found?.errors.length > 0 && !(await confirmed(t("store_ask")))) {
    return "";
  }
  const added = await ask("/api/tasks", { xml: given.xml, description: at("description").value });
  await load();
  return t(added.already_stored ? "stored_before" : "stored", added);
}

/** The name of a template is that of its file. What it leaves to the tasks that call it counts as an error in the check. */
async function storeTemplate() {
  const name = given.name.replace(/\.xml$/i, "");
  const wanted = { name, xml: given.xml, description: at("description").value };
  let added;
  try {
    added = await ask("/api/templates", wanted);
  } catch (error) {
    if (error.reason?.code !== "TEMPLATE_EXISTS") {
      throw error;
    }
    if (!(await confirmed(t("replace_ask", { name })))) {
      return "";
    }
    added = await ask("/api/templates", { ...wanted, replace: true });
  }
  await load();
  return t(added.already_stored ? "same_template" : "stored_template", { name });
}

async function showDifference() {
  const id = at("compare").value;
  const box = at("difference");
  box.hidden = id === "" || given === null;
  if (!box.hidden) {
    const { text } = await ask(`/api/tasks/${id}/diff`, { xml: given.xml });
    box.replaceChildren(...(text === "" ? [t("equal")] : text.split("\n").map((line) => (
      make("span", { className: line.startsWith("+") ? "added" : line.startsWith("-") ? "removed" : "" }, `${line}\n`)))));
  }
  return "";
}

// stored ones

function buildTask(task) {
  const remove = (event) => once(event.currentTarget, async () => {
    if (!(await confirmed(t("remove_ask", { id: task.id })))) {
      return "";
    }
    await ask(`/api/tasks/${task.id}/remove`, {});
    await load();
    return t("removed", { id: task.id });
  });
  const download = (event) => once(event.currentTarget, () => save(task.id));
  return make("tr", {}, ...parts("td", ["id", "model", "description", "added"]), make("td", { className: "bar" },
    button("download", "", download, ["download_task", { id: task.id }]), button("remove", "", remove, ["remove_task", { id: task.id }])));
}

function fillTask(row, task) {
  setText(part(row, "id"), String(task.id));
  setText(part(row, "model"), task.model_name);
  setText(part(row, "description"), task.description);
  setText(part(row, "added"), when(task.added_at));
}

function fillTemplate(row, template) {
  setText(part(row, "name"), template.name);
  setText(part(row, "model"), template.model_name);
  setText(part(row, "description"), template.description);
  setText(part(row, "added"), when(template.added_at));
}

async function save(id) {
  const { xml } = await ask(`/api/tasks/${id}`);
  const url = URL.createObjectURL(new Blob([xml], { type: "text/xml" }));
  make("a", { href: url, download: `task_${id}.xml` }).click();
  URL.revokeObjectURL(url);
  say("");
  return "";
}
