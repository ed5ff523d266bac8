// Edits of the text of a task. Each gives the new text; elements of the old one have no place in it: parse it again.
import { type Element, encoded } from "./xml";

const UNIT = "    "; // an indentation, as Groot writes it
const REST_OF_LINE = /[ \t]*(?:<!--[^\n]*?-->[ \t]*)*(?=\r?\n)/y; // blanks and comments
const MARKUP = /<!--[\s\S]*?-->|<!\[CDATA\[[\s\S]*?\]\]>|<(?:[^<>"']|"[^"]*"|'[^']*')*>/g;

interface Replaced {
  from: number;
  to: number;
  by: string;
}

function edited(text: string, ...edits: Replaced[]): string {
  const ordered = edits.sort((a, b) => b.from - a.from || b.to - a.to);
  return ordered.reduce((now, { from, to, by }) => now.slice(0, from) + by + now.slice(to), text);
}

const endOfLine = (text: string) => (text.includes("\r\n") ? "\r\n" : "\n");

/** Blanks before an element that is the first of its line, else null. */
function ownIndent(text: string, element: Element): string | null {
  const begin = text.lastIndexOf("\n", element.from - 1) + 1;
  const before = text.slice(begin, element.from);
  return before.trim() === "" ? before : null;
}

function indentOf(text: string, element: Element): string {
  const begin = text.lastIndexOf("\n", element.from - 1) + 1;
  return /^[ \t]*/.exec(text.slice(begin, element.from))?.[0] ?? "";
}

const childIndent = (text: string, parent: Element) =>
  (parent.children[0] && ownIndent(text, parent.children[0])) ?? indentOf(text, parent) + UNIT;

/** With other indentation between its tags: values and comments of several lines stay. */
function shifted(source: string, before: string, after: string): string {
  let kept = 0;
  let result = "";
  const shift = (blank: string) =>
    blank.replace(
      /\n([ \t]*)/g,
      (_, own: string) => `\n${after}${own.startsWith(before) ? own.slice(before.length) : own}`,
    );
  for (const found of source.matchAll(MARKUP)) {
    result += shift(source.slice(kept, found.index)) + found[0];
    kept = found.index + found[0].length;
  }
  return result + shift(source.slice(kept));
}

/** An element as a text of its own, which can be inserted elsewhere. */
export const copied = (text: string, element: Element) =>
  shifted(text.slice(element.from, element.to), indentOf(text, element), "");

/** Sets an attribute, or takes it away with null. */
export function withAttribute(text: string, element: Element, name: string, value: string | null): string {
  const known = element.attributes.find((one) => one.name === name);
  if (known === undefined) {
    const place = element.attributes.at(-1)?.to ?? element.from + 1 + element.tag.length;
    return value === null ? text : edited(text, { from: place, to: place, by: ` ${name}="${encoded(value)}"` });
  }
  if (value === null) {
    const blanks = /\s*$/.exec(text.slice(element.from, known.from))?.[0].length ?? 0;
    return edited(text, { from: known.from - blanks, to: known.to, by: "" });
  }
  const [from, to] = known.inner;
  return value === known.value ? text : edited(text, { from, to, by: encoded(value, text[to]) });
}

function insertion(text: string, parent: Element, index: number, source: string): Replaced {
  const line = endOfLine(text);
  const indent = childIndent(text, parent);
  const child = line + indent + shifted(source.replace(/\r?\n/g, line), "", indent);
  const last = line + indentOf(text, parent);
  if (parent.empty) {
    const slash = parent.open - 2;
    const from = slash - (/\s*$/.exec(text.slice(parent.from, slash))?.[0].length ?? 0);
    return { from, to: parent.open, by: `>${child}${last}</${parent.tag}>` };
  }
  const before = parent.children[index - 1];
  const anchor = before?.to ?? parent.open;
  REST_OF_LINE.lastIndex = anchor;
  const from = anchor + (REST_OF_LINE.exec(text)?.[0].length ?? 0);
  return { from, to: from, by: child + (from === parent.close ? last : "") };
}

/** An element's text below a parent, as its child number `index`. */
export const inserted = (text: string, parent: Element, index: number, source: string) =>
  edited(text, insertion(text, parent, index, source));

/** Takes with it the line that it alone stands on. */
function removal(text: string, element: Element): Replaced {
  const indent = ownIndent(text, element);
  const alone = indent !== null && /^[ \t]*(?:\r?\n|$)/.test(text.slice(element.to, element.to + 200));
  const begin = element.from - (indent?.length ?? 0);
  const breaks = text.endsWith("\r\n", begin) ? 2 : 1;
  return { from: alone ? Math.max(0, begin - breaks) : element.from, to: element.to, by: "" };
}

export const removed = (text: string, element: Element) => edited(text, removal(text, element));

export const isInside = (element: Element | null, other: Element): boolean =>
  element !== null && (element === other || isInside(element.parent, other));

/** Moves an element to before the present child number `index` of a parent; the same text where it cannot. */
export function moved(text: string, element: Element, parent: Element, index: number): string {
  const own = parent.children.indexOf(element);
  if (isInside(parent, element) || (own >= 0 && (index === own || index === own + 1))) {
    return text;
  }
  return edited(text, removal(text, element), insertion(text, parent, index, copied(text, element)));
}

/** Puts an element into a new one, whose text is one empty tag. */
export function wrapped(text: string, element: Element, source: string): string {
  const line = endOfLine(text);
  const indent = indentOf(text, element);
  const inside = shifted(text.slice(element.from, element.to), indent, indent + UNIT);
  const tag = /^<([^\s/>]+)/.exec(source)?.[1] ?? "";
  const by = `${source.replace(/\s*\/>$/, ">")}${line}${indent}${UNIT}${inside}${line}${indent}</${tag}>`;
  return edited(text, { from: element.from, to: element.to, by });
}
