// Values of records as people read and write them.
import type { FieldGiven, Stored } from "../models";
import { texts } from "../texts";

export const TYPES = ["double", "int", "bool", "string", "double[]", "int[]", "bool[]", "string[]"] as const;
export type Type = (typeof TYPES)[number];
type Value = Stored["values"][string];

const EXAMPLES: Record<Type, string> = {
  double: "-1.05",
  int: "3",
  bool: "true",
  string: "",
  "double[]": "[1.0, -2.5]",
  "int[]": "[1, 2]",
  "bool[]": "[true]",
  "string[]": '["a"]',
};
const LONGEST = 100; // letters of a document
const DIGITS = 6; // more precise than any machine

export const nameOf = (record: Stored) => `${record.model_name}/${record.record_name}`;

/** A value as it is stored: a whole number of a double has its point. */
export function exact(value: Value, type: string | undefined): string {
  if (type === "document") {
    return JSON.stringify(value);
  }
  const one = (part: unknown) =>
    type?.startsWith("double") && Number.isInteger(part) ? (part as number).toFixed(1) : String(part);
  return Array.isArray(value) ? `[${value.map(one).join(", ")}]` : one(value);
}

/** A value for display. */
function written(value: Value, type: string | undefined): string {
  if (type === "document") {
    const whole = JSON.stringify(value);
    return whole.length > LONGEST ? `${whole.slice(0, LONGEST)}…` : whole;
  }
  const one = (part: unknown) =>
    type?.startsWith("double") && typeof part === "number" ? Number(part.toPrecision(DIGITS)) : part;
  return exact((Array.isArray(value) ? value.map(one) : one(value)) as Value, type);
}

/** Fields with values and units; `record` knows types and units. */
export const listed = (values: Stored["values"], record: Stored | undefined) =>
  Object.entries(values)
    .map(([name, value]) => `${name}: ${written(value, record?.types[name])} ${record?.units[name] ?? ""}`.trim())
    .join(", ");

/** The typed text as a value of the field's type; the server checks it again. Throws an Error that people can read. */
export function typed(name: string, type: Type, text: string): FieldGiven {
  if (name === "") {
    throw new Error(texts.t("field_nameless"));
  }
  if (type === "string") {
    return { name, type, value: text };
  }
  try {
    return { name, type, value: JSON.parse(text) };
  } catch {
    throw new Error(
      texts.t("bad_value", { field: name, text, type: texts.t(`type_${type}`), example: EXAMPLES[type] }),
    );
  }
}
