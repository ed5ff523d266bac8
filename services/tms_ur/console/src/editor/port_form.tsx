// The form of the chosen node: its name and its ports, with what the site knows for them.
import { type KeyboardEvent, useEffect, useId, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Stored } from "../models";
import { Said } from "../said";
import { type EditNode, portsOf } from "./groot";
import { CALL, type Port } from "./palette";
import { RecordMaker } from "./record_maker";
import type { Site } from "./site";
import type { Marks } from "./use_check";
import { valueIn } from "./xml";

interface Props {
  node: EditNode;
  site: Site;
  marks: Marks | undefined;
  onSet: (name: string, value: string) => void;
  onTree: (id: string) => void;
  onRecord: () => void; // a record was made
}

const RECORDS = ["record_name", "target_record_name", "previous_target_record_name"];

/** Records that a leaf of a machine can name. */
const recordsOf = (site: Site, machine: string) =>
  site.records.filter((one) => one.model_name === machine || one.model_name === "");

/** What the site knows for a port. */
export function optionsFor(port: Port, node: EditNode, site: Site): string[] {
  const worker = site.workers.find((one) => one.name === node.machine);
  const value = (name: string) => valueIn(node.element, name) ?? "";
  if (RECORDS.includes(port.name)) {
    return recordsOf(site, node.machine).map((one) => one.record_name);
  }
  if (port.type === "bool") {
    return ["true", "false"];
  }
  const known: Record<string, () => string[]> = {
    model_name: () => site.workers.map((one) => one.name),
    subtask_name: () =>
      node.type === CALL ? site.templates : (worker?.subtasks.filter((one) => !one.startsWith("primitive_")) ?? []),
    primitive_name: () => worker?.subtasks.filter((one) => one.startsWith("primitive_")) ?? [],
    mongo_record_name: () => site.records.map((one) => one.record_name),
    mongo_param_name: () =>
      site.records
        .filter((one) => one.record_name === value("mongo_record_name"))
        .flatMap((one) => Object.keys(one.values)),
  };
  return [...new Set(known[port.name]?.() ?? [])];
}

export function PortForm({ node, site, marks, onSet, onTree, onRecord }: Props) {
  const { t } = useTranslation();
  const type = site.types.get(node.type);
  const ports = type?.ports ?? [];
  const value = (name: string) => valueIn(node.element, name) ?? "";
  const others = portsOf(node.element).filter((one) => !ports.some((port) => port.name === one.name));
  const more = others.map((one): Port => ({ name: one.name, type: "", fallback: "", help: "" }));
  const name: Port = { name: "name", type: "", fallback: "", help: t("ed_name_help") };
  return (
    <section id="ed_form" aria-label={t("ed_form")}>
      <h3>{node.type}</h3>
      {type && <p>{type.help}</p>}
      {[...(marks?.errors ?? []), ...(marks?.warnings ?? [])].map((one) => (
        <p key={JSON.stringify(one.reason.args) + one.reason.code} className="bad">
          <Said reason={one.reason} done="edit_task" />
        </p>
      ))}
      {node.kind === "subtree" && (
        <button type="button" onClick={() => onTree(value("ID"))}>
          {t("ed_open_tree", { name: value("ID") })}
        </button>
      )}
      {[...(node.kind === "subtree" ? [] : [name]), ...ports, ...more].map((port) => (
        <div key={port.name}>
          <Field
            port={port}
            given={value(port.name)}
            options={optionsFor(port, node, site)}
            onSet={(text) => onSet(port.name, text)}
          />
          {RECORDS.includes(port.name) && (
            <RecordMaker
              machine={node.machine}
              records={site.records}
              onMade={(record) => {
                onRecord();
                onSet(port.name, record);
              }}
            />
          )}
        </div>
      ))}
      {RECORDS.map((port) => (
        <Fields key={port} record={recordsOf(site, node.machine).find((one) => one.record_name === value(port))} />
      ))}
    </section>
  );
}

interface FieldProps {
  port: Port;
  given: string;
  options: string[];
  onSet: (value: string) => void;
}

/** A value counts when the field is left, or with Enter: each is one step back. */
function Field({ port, given, options, onSet }: FieldProps) {
  const id = useId();
  const [text, setText] = useState(given);
  useEffect(() => setText(given), [given]);
  const done = () => text !== given && onSet(text);
  const props = {
    id,
    value: text,
    placeholder: port.fallback,
    "aria-describedby": `${id}h`,
    onChange: (event: { target: { value: string } }) => setText(event.target.value),
    onBlur: done,
  };
  const entered = (event: KeyboardEvent) => {
    if (event.key === "Enter") {
      done();
    }
  };
  return (
    <div className="ed_field">
      <label htmlFor={id}>{port.name}</label>
      {text.includes("\n") ? (
        <textarea {...props} rows={4} />
      ) : (
        <input {...props} list={`${id}o`} onKeyDown={entered} />
      )}
      <datalist id={`${id}o`}>
        {options.map((one) => (
          <option key={one} value={one} />
        ))}
      </datalist>
      <small id={`${id}h`}>{port.help}</small>
    </div>
  );
}

/** The fields of the record that the node names. */
function Fields({ record }: { record: Stored | undefined }) {
  const { t } = useTranslation();
  if (record === undefined) {
    return null;
  }
  return (
    <>
      <h4>
        {t("record")} {record.record_name}
      </h4>
      <dl className="ed_record">
        {Object.entries(record.values ?? {}).map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>
              {JSON.stringify(value)} {record.units?.[name]}
            </dd>
          </div>
        ))}
      </dl>
      <a className="button" href="#data">
        {t("ed_to_records")}
      </a>
    </>
  );
}
