// Groot's XML with the place of everything in its text. The text itself is the document: an edit replaces what it
// changes, and all else stays byte for byte, comments and unknown attributes included.

export interface Attribute {
  name: string;
  value: string; // without entities
  from: number; // of its name
  to: number; // after its closing quote
  inner: [number, number]; // between its quotes
}

export interface Element {
  tag: string;
  attributes: Attribute[];
  children: Element[];
  parent: Element | null;
  comment: string; // the last comment before it, below the same parent
  empty: boolean; // its start tag is all of it: <A/>
  from: number; // of its start tag
  open: number; // after its start tag
  close: number; // of its end tag
  to: number; // after its end
}

/** The text is no well-formed XML. */
export class XmlError extends Error {
  constructor(readonly line: number) {
    super(`line ${line}: no well-formed XML`);
  }
}

const COMMENT = /<!--([\s\S]*?)-->/y;
const OPAQUE = /<!\[CDATA\[[\s\S]*?\]\]>|<\?[\s\S]*?\?>/y; // a DOCTYPE is refused by the server, too
const END = /<\/([^\s<>]+)\s*>/y;
const START = /<([^\s/<>"'=!?]+)((?:[^<>"'/]|"[^"<]*"|'[^'<]*'|\/(?!>))*)(\/?)>/y;
const ATTRIBUTE = /\s+([^\s=/"'<>]+)\s*=\s*(?:"([^"]*)"|'([^']*)')/y;

const at = (pattern: RegExp, text: string, position: number) => {
  pattern.lastIndex = position;
  return pattern.exec(text);
};

export const lineAt = (text: string, position: number) => text.slice(0, position).split("\n").length;

/** The root element; throws an XmlError. */
export function parse(text: string): Element {
  let here: Element | null = null;
  let root: Element | null = null;
  let comment = "";
  for (let position = text.indexOf("<"); position >= 0; ) {
    const said = at(COMMENT, text, position);
    const found: RegExpExecArray | null = said ?? at(OPAQUE, text, position) ?? at(END, text, position);
    const begun: RegExpExecArray | null = found === null ? at(START, text, position) : null;
    const end = position + (found ?? begun ?? [""])[0].length;
    if (said !== null) {
      comment = said[1] ?? "";
    } else if (begun !== null && (here !== null || root === null)) {
      const made = started(begun, here, comment, text);
      comment = "";
      here?.children.push(made);
      root ??= made;
      here = made.empty ? here : made;
    } else if (found?.[0].startsWith("</") && here !== null && here.tag === found[1]) {
      [here.close, here.to, comment] = [position, end, ""];
      here = here.parent;
    } else if (!found || found[0].startsWith("</")) {
      throw new XmlError(lineAt(text, position));
    }
    position = text.indexOf("<", end);
  }
  if (root === null || here !== null) {
    throw new XmlError(lineAt(text, here?.from ?? text.length));
  }
  return root;
}

function started(found: RegExpExecArray, parent: Element | null, comment: string, text: string): Element {
  const [all, tag = "", inside = "", slash] = found;
  const from = found.index;
  const end = from + 1 + tag.length + inside.length;
  const attributes: Attribute[] = [];
  let position = from + 1 + tag.length;
  for (let one = at(ATTRIBUTE, text, position); one !== null && position < end; one = at(ATTRIBUTE, text, position)) {
    const [whole, name = "", double, single] = one;
    const raw = double ?? single ?? "";
    position += whole.length;
    const inner: [number, number] = [position - 1 - raw.length, position - 1];
    attributes.push({ name, value: decoded(raw), from: one.index + whole.indexOf(name), to: position, inner });
  }
  if (text.slice(position, end).trim() !== "") {
    throw new XmlError(lineAt(text, position));
  }
  const open = from + all.length;
  return { tag, attributes, children: [], parent, comment, empty: slash === "/", from, open, close: open, to: open };
}

const NAMED: Record<string, string> = { amp: "&", lt: "<", gt: ">", quot: '"', apos: "'" };

function decoded(raw: string): string {
  return raw.replace(/&(?:#x([0-9a-f]+)|#(\d+)|(\w+));/gi, (all, hex, decimal, name) => {
    if (name) {
      return NAMED[name] ?? all;
    }
    const code = hex ? Number.parseInt(hex, 16) : Number(decimal);
    return code <= 0x10ffff ? String.fromCodePoint(code) : all;
  });
}

const ENTITIES: Record<string, string> = {
  "&": "&amp;",
  "<": "&lt;",
  ">": "&gt;",
  '"': "&quot;",
  "'": "&apos;",
  "\n": "&#10;",
  "\r": "&#13;",
  "\t": "&#9;",
};

/** A value as it stands between quotes, written as Groot does. */
export const encoded = (value: string, quote = '"') =>
  value.replace(/[&<>"'\n\r\t]/g, (one) => (/["']/.test(one) && one !== quote ? one : (ENTITIES[one] ?? one)));

export const valueIn = (element: Element, name: string) => element.attributes.find((one) => one.name === name)?.value;

/** An element and all below it, in the order of the text. */
export function* everyElement(element: Element): Generator<Element> {
  yield element;
  for (const child of element.children) {
    yield* everyElement(child);
  }
}
