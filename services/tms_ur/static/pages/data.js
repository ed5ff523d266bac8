// Data: records with type, age, source and history; static ones can be edited; and the sensing inputs.
import { at, button, duration, heading, keep, make, part, parts, setBadge, setText, table } from "../dom.js";
import { fillReason, once, showError } from "../reasons.js";
import { ask, siteNow } from "../server.js";
import { t, when } from "../strings.js";

const SENSING_EVERY = 2000; // ms

let records = null;
let sensingAsked = 0;

export function build(root) {
  const filter = make("input", { id: "record_filter", type: "search", oninput: show });
  root.append(
    heading("p_data"), make("p", { id: "data_problem", className: "bad", role: "status" }),
    make("label", {}, make("span", { data: { t: "filter" } }), filter),
    button("new_record", "", () => openNew()),
    make("p", { id: "none_records", hidden: true, data: { t: "none_records" } }),
    make("section", { id: "editor", hidden: true }),
    table("list_records", "p_data", ["record", "type", "age", "source", "values", "commands"]),
    make("section", { id: "values", hidden: true }, make("h2", { id: "values_title" }), button("close", "", () => { at("values").hidden = true; }),
      make("p", { id: "none_values", data: { t: "none_values" } }), table("list_values", "record_history", ["at_time", "source", "values"])),
    heading("sensing"), make("p", { id: "none_sensing", hidden: true, data: { t: "none_sensing" } }),
    table("list_sensing", "sensing", ["input", "state", "topic", "hz", "age", "accepted", "refusals", "last_refusal", "record"]),
    heading("edits"), table("list_changes", "edits", ["at_time", "who", "target"]),
  );
  records = null;
  sensingAsked = 0;
}

export async function load() {
  try {
    records = await ask("/api/parameters");
    showError(at("data_problem"), null);
    const audit = (await ask("/api/audit?hours=720")).filter((event) => event.kind === "set_parameter").reverse();
    keep(at("list_changes"), audit, (event) => event.number, () => make("tr", {}, ...parts("td", ["time", "who", "target"])), (row, event) => {
      setText(part(row, "time"), when(event.stamp));
      setText(part(row, "who"), event.text);
      setText(part(row, "target"), event.node);
    });
  } catch (error) {
    showError(at("data_problem"), error);
  }
  show();
}

export function update() {
  at("list_records")?.querySelectorAll("[data-stamp]").forEach((cell) => setText(cell, age(cell.dataset.stamp)));
  if (Date.now() - sensingAsked > SENSING_EVERY) {
    sensingAsked = Date.now();
    showSensing();
  }
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
const age = (stamp) => (stamp ? duration(Math.max(0, (siteNow() - new Date(stamp)) / 1000)) : t("never"));

function build_row(record) {
  const edit = button("edit", "", () => openEditor(nameOf(record)), ["edit_record", { name: nameOf(record) }]);
  edit.hidden = record.type !== "static";
  return make("tr", {}, ...parts("td", ["name", "type", "age", "source"]), make("td", { data: { part: "values" }, className: "values" }),
    make("td", { className: "bar" }, edit, button("record_history", "", (event) => once(event.currentTarget, () => showValues(record)), ["history_of", { name: nameOf(record) }])));
}

function fillRow(row, record) {
  setText(part(row, "name"), nameOf(record));
  setText(part(row, "type"), t(record.type));
  part(row, "age").dataset.stamp = record.updated_at ?? "";
  setText(part(row, "age"), age(record.updated_at));
  setText(part(row, "source"), record.source);
  setText(part(row, "values"), listed(record.values, record));
}

/** Fields with values and units; `record` knows types and units. */
function listed(values, record) {
  const one = ([name, value]) => [`${name}: ${written(value, record?.types[name])}`, record?.units[name]].filter(Boolean).join(" ");
  return Object.entries(values).map(one).join(", ");
}

const LONGEST = 100; // letters of a document

/** A value as it is stored. */
function exact(value, type) {
  if (type === "document") {
    return JSON.stringify(value);
  }
  const one = (number) => (type?.startsWith("double") && Number.isInteger(number) ? number.toFixed(1) : String(number));
  return Array.isArray(value) ? `[${value.map(one).join(", ")}]` : one(value);
}

/** A value for display: six digits are more precise than any machine. */
function written(value, type) {
  if (type === "document") {
    const whole = JSON.stringify(value);
    return whole.length > LONGEST ? `${whole.slice(0, LONGEST)}…` : whole;
  }
  const one = (number) => (type?.startsWith("double") && typeof number === "number" ? Number(number.toPrecision(6)) : number);
  return exact(Array.isArray(value) ? value.map(one) : one(value), type);
}

// history and sensing

async function showValues(record) {
  const query = new URLSearchParams({ model_name: record.model_name, record_name: record.record_name });
  const changes = await ask(`/api/parameters/history?${query}`);
  if (at("values") === null) {
    return;
  }
  const present = records.find((one) => nameOf(one) === nameOf(record));
  setText(at("values_title"), t("values_of", { name: nameOf(record) }));
  at("none_values").hidden = changes.length > 0;
  at("list_values").replaceChildren(...changes.map((change) => make("tr", {}, make("td", {}, when(change.stamp)), make("td", {}, change.source),
    make("td", { className: "values" }, listed(change.values, present)))));
  at("values").hidden = false;
  at("values").scrollIntoView();
}

const SENSING_STATES = { silent: "no_messages" }; // for machines `silent` has another text

async function showSensing() {
  let inputs = [];
  try {
    ({ inputs } = await ask("/api/sensing"));
  } catch {
    return; // the top of the page reports a lost server
  }
  if (at("list_sensing") === null) {
    return;
  }
  at("none_sensing").hidden = inputs.length > 0;
  keep(at("list_sensing"), inputs, (one) => one.name,
    () => make("tr", {}, ...parts("td", ["name"]), make("td", {}, ...parts("span", ["state"])), ...parts("td", ["topic", "hz", "age", "accepted", "refused", "why", "records"])), fillInput);
}

function fillInput(row, one) {
  setText(part(row, "name"), one.name);
  setBadge(part(row, "state"), SENSING_STATES[one.state] ?? one.state);
  setText(part(row, "topic"), one.topic);
  setText(part(row, "hz"), one.hz_expected === null ? `${one.hz.toFixed(1)} Hz` : `${one.hz.toFixed(1)} / ${one.hz_expected} Hz`);
  setText(part(row, "age"), one.age === null ? "-" : duration(one.age));
  setText(part(row, "accepted"), String(one.accepted));
  setText(part(row, "refused"), String(one.refused));
  fillReason(part(row, "why"), one.last_refusal);
  setText(part(row, "records"), one.records.join(", "));
}

// editing

const TYPES = ["double", "int", "bool", "string", "double[]", "int[]", "bool[]", "string[]"];
const EXAMPLES = { double: "-1.05", int: "3", bool: "true", string: "", "double[]": "[1.0, -2.5]", "int[]": "[1, 2]", "bool[]": "[true]", "string[]": "[\"a\"]" };

/** Documents are not edited here. */
function openEditor(name) {
  const record = records.find((one) => nameOf(one) === name);
  const fields = Object.keys(record.values).filter((field) => record.types[field] !== "document").map((field) => {
    const input = make("input", { id: `field_${field}`, value: exact(record.values[field], record.types[field]), data: { field, type: record.types[field] } });
    input.dataset.before = input.value;
    return make("label", {}, make("span", {}, [field, record.units[field] && `[${record.units[field]}]`, `(${t(`type_${record.types[field]}`)})`].filter(Boolean).join(" ")), input);
  });
  showEditor(t("edit_record", { name }), fields, () => saveFields(record));
}

function openNew() {
  const model = make("input", { id: "new_model", maxLength: 64 });
  const record = make("input", { id: "new_name", maxLength: 100 });
  const fields = make("div", { id: "new_fields" });
  const add = () => fields.append(make("div", { className: "bar new_field" }, make("input", { ariaLabel: t("field_name"), placeholder: t("field_name"), maxLength: 100 }),
    make("select", { ariaLabel: t("type") }, ...TYPES.map((type) => make("option", { value: type }, t(`type_${type}`)))), make("input", { ariaLabel: t("values"), placeholder: "-1.05" })));
  add();
  showEditor(t("new_record"), [make("label", {}, make("span", {}, t("model")), model), make("label", {}, make("span", {}, t("record")), record), fields, button("add_field", "", add)], saveNew);
}

function showEditor(title, inner, save) {
  at("editor").replaceChildren(make("h2", {}, title), ...inner, make("p", { id: "editor_problem", className: "bad", role: "alert" }),
    make("div", { className: "bar" }, button("save", "go", (event) => once(event.currentTarget, () => saved(save))), button("close", "", () => { at("editor").hidden = true; })));
  at("editor").hidden = false;
  at("editor").scrollIntoView();
  at("editor").querySelector("input")?.focus();
}

/** Saves, and shows an error in the editor. */
async function saved(save) {
  showError(at("editor_problem"), null);
  let name;
  try {
    name = await save();
  } catch (error) {
    showError(at("editor_problem"), error);
    return "";
  }
  at("editor").hidden = true;
  await load();
  return t("saved", { name });
}

async function saveFields(record) {
  const changed = [...at("editor").querySelectorAll("[data-field]")].filter((input) => input.value !== input.dataset.before);
  const fields = changed.map((input) => typed(input.dataset.field, input.dataset.type, input.value));
  await ask("/api/parameters", { model_name: record.model_name, record_name: record.record_name, fields });
  return nameOf(record);
}

async function saveNew() {
  const fields = [...at("new_fields").children].map((row) => typed(...[...row.children].map((one) => one.value.trim())));
  const record = { model_name: at("new_model").value.trim(), record_name: at("new_name").value.trim() };
  if (records?.some((one) => nameOf(one) === nameOf(record))) {
    throw new Error(t("record_there", { name: nameOf(record) }));
  }
  await ask("/api/parameters", { ...record, fields, create: true, type: "static" });
  return nameOf(record);
}

/** The typed text as a value of the field's type; the server checks it again. */
function typed(name, type, text) {
  if (name === "") {
    throw new Error(t("field_nameless"));
  }
  if (type === "string") {
    return { name, type, value: text };
  }
  try {
    return { name, type, value: JSON.parse(text) };
  } catch {
    throw new Error(t("bad_value", { field: name, text, type: t(`type_${type}`), example: EXAMPLES[type] }));
  }
}
