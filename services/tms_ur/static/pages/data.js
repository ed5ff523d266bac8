// Data: records with type, age and source; static ones can be edited, every edit is audited.
import { at, button, duration, heading, keep, make, once, part, parts, setText, table } from "../dom.js";
import { ask } from "../server.js";
import { t, when } from "../strings.js";

let records = null;

export function build(root) {
  const filter = make("input", { id: "record_filter", type: "search", oninput: show });
  root.append(
    heading("p_data"), make("p", { id: "lists_problem", className: "bad", role: "status" }),
    make("label", {}, make("span", { data: { t: "filter" } }), filter),
    make("p", { id: "none_records", hidden: true, data: { t: "none_records" } }),
    table("list_records", ["record", "type", "age", "source", "values", "edit"]),
    make("section", { id: "editor", hidden: true }), heading("changes"), table("list_changes", ["at_time", "who", "target"]),
  );
  records = null;
}

export async function load() {
  try {
    records = await ask("/api/parameters");
    setText(at("lists_problem"), "");
    const audit = (await ask("/api/audit?hours=720")).filter((event) => event.kind === "set_parameter").reverse();
    keep(at("list_changes"), audit, (event) => event.number, () => make("tr", {}, ...parts("td", ["time", "who", "target"])), (row, event) => {
      setText(part(row, "time"), when(event.stamp));
      setText(part(row, "who"), event.text);
      setText(part(row, "target"), event.node);
    });
  } catch (error) {
    if (at("lists_problem") !== null) {
      setText(at("lists_problem"), error.message);
    }
  }
  show();
}

export function update() {
  at("list_records")?.querySelectorAll("[data-stamp]").forEach((cell) => setText(cell, age(cell.dataset.stamp)));
}

function show() {
  if (records === null || at("list_records") === null) {
    return;
  }
  const wanted = at("record_filter").value.toLowerCase();
  const found = records.filter((record) => nameOf(record).toLowerCase().includes(wanted));
  at("none_records").hidden = found.length > 0;
  keep(at("list_records"), found, nameOf, build_row, fillRow);
}

const nameOf = (record) => `${record.model_name}/${record.record_name}`;
const age = (stamp) => (stamp ? duration(Math.max(0, (Date.now() - new Date(stamp)) / 1000)) : t("never"));

function build_row(record) {
  const edit = button("edit", "", () => openEditor(nameOf(record)), ["edit_record", { name: nameOf(record) }]);
  edit.hidden = record.type !== "static";
  return make("tr", {}, ...parts("td", ["name", "type", "age", "source"]), make("td", { data: { part: "values" }, className: "values" }), make("td", {}, edit));
}

function fillRow(row, record) {
  setText(part(row, "name"), nameOf(record));
  setText(part(row, "type"), t(record.type));
  part(row, "age").dataset.stamp = record.updated_at ?? "";
  setText(part(row, "age"), age(record.updated_at));
  setText(part(row, "source"), record.source);
  setText(part(row, "values"), Object.entries(record.values).map(([name, value]) => `${name}: ${written(value, record.types[name])}`).join(", "));
}

function written(value, type) {
  const one = (number) => (type?.startsWith("double") && Number.isInteger(number) ? number.toFixed(1) : String(number));
  return Array.isArray(value) ? `[${value.map(one).join(", ")}]` : one(value);
}

// editing

function openEditor(name) {
  const record = records.find((one) => nameOf(one) === name);
  const fields = Object.keys(record.values).map((field) => {
    const input = make("input", { id: `field_${field}`, value: written(record.values[field], record.types[field]), data: { field } });
    return make("label", {}, make("span", {}, `${field} (${record.types[field]})`), input);
  });
  const save = (event) => once(event.currentTarget, () => saveRecord(record));
  at("editor").replaceChildren(make("h2", {}, t("edit_record", { name })), ...fields,
    make("div", { className: "bar" }, button("save", "go", save), button("close", "", () => { at("editor").hidden = true; })));
  at("editor").hidden = false;
  at("editor").querySelector("input")?.focus();
}

async function saveRecord(record) {
  const inputs = [...at("editor").querySelectorAll("[data-field]")];
  const changed = inputs.filter((input) => input.value !== written(record.values[input.dataset.field], record.types[input.dataset.field]));
  const fields = changed.map((input) => ({ name: input.dataset.field, type: record.types[input.dataset.field],
    value: parsed(input.value, record.types[input.dataset.field], input.dataset.field) }));
  await ask("/api/parameters", { model_name: record.model_name, record_name: record.record_name, fields });
  at("editor").hidden = true;
  await load();
  return t("saved", { name: nameOf(record) });
}

/** What a person typed, as the field's type wants it; the server looks at it again. */
function parsed(text, type, field) {
  if (type === "string") {
    return text;
  }
  try {
    return JSON.parse(text);
  } catch {
    throw new Error(`${field}: '${text}' (${type})`);
  }
}
