// @vitest-environment jsdom
import { expect, test } from "vitest";
import { copied, inserted, moved, removed, withAttribute, wrapped } from "./edits";
import { type Element, encoded, everyElement, lineAt, parse, valueIn, XmlError } from "./xml";

const FILES = import.meta.glob("../../../../../tests/data/field_tasks/*.xml", {
  eager: true,
  query: "?raw",
  import: "default",
});
const FIELD = Object.entries(FILES as Record<string, string>).map(
  ([path, text]) => [path.replace(/.*\//, ""), text] as const,
);
const XML = /<.*>/s;

/** What the browser's own parser finds. */
function seen(text: string): string[] {
  const found = new DOMParser().parseFromString(text.replace(/^\s+/, ""), "text/xml");
  return [...found.querySelectorAll("*")].map(
    (one) => `${one.tagName} ${[...one.attributes].map(({ name, value }) => `${name}=${value}`).join(" ")}`,
  );
}

const ours = (root: Element) =>
  [...everyElement(root)].map(
    (one) => `${one.tag} ${one.attributes.map(({ name, value }) => `${name}=${value}`).join(" ")}`,
  );

/** Lines of which one text has other ones than the other, after what both begin and end with. */
function changed(before: string, after: string): [string[], string[]] {
  const [old, now] = [before.split("\n"), after.split("\n")];
  while (old.length > 0 && now.length > 0 && old[0] === now[0]) {
    old.shift();
    now.shift();
  }
  while (old.length > 0 && now.length > 0 && old.at(-1) === now.at(-1)) {
    old.pop();
    now.pop();
  }
  return [old, now];
}

const nodes = (text: string) =>
  [...everyElement(parse(text))].filter((one) => {
    for (let up = one.parent; up !== null; up = up.parent) {
      if (up.tag === "BehaviorTree") {
        return true;
      }
    }
    return false;
  });

function find(text: string, name: string): Element {
  const found = [...everyElement(parse(text))].find((one) => one.tag === name || valueIn(one, "name") === name);
  if (found === undefined) {
    throw new Error(name);
  }
  return found;
}

test("all tasks of the field are here", () => {
  expect(FIELD.length).toBe(20);
});

test.each(FIELD)("%s is read as the browser reads it, with every element's place", (_, text) => {
  const root = parse(text);
  expect(ours(root)).toEqual(seen(text));
  for (const one of everyElement(root)) {
    expect(text.slice(one.from)).toMatch(new RegExp(`^<${one.tag}[\\s/>]`));
    expect(text.slice(one.from, one.to)).toMatch(XML);
    expect(one.empty || text.slice(one.close, one.to).startsWith(`</${one.tag}`)).toBe(true);
  }
});

test.each(FIELD)("in %s an edit changes its own lines, and its opposite gives the same text", (_, text) => {
  const all = nodes(text);
  const step = Math.ceil(all.length / 30);
  for (let index = 0; index < all.length; index += step) {
    const node = all[index] as Element;
    const line = text.split("\n")[lineAt(text, node.from) - 1];
    const named = withAttribute(text, node, "_new", `a<"b"&\n'c'`);
    expect(changed(text, named)[0]).toEqual([line]);
    const again = nodes(named)[index] as Element;
    expect(valueIn(again, "_new")).toBe(`a<"b"&\n'c'`);
    expect(withAttribute(named, again, "_new", null)).toBe(text);
    const number = node.parent?.children.indexOf(node) ?? 0;
    const more = inserted(text, node.parent as Element, number, "<AlwaysSuccess/>");
    expect(changed(text, more)).toEqual([[], [expect.stringMatching(/^\s+<AlwaysSuccess\/>$/)]]);
    expect(removed(more, nodes(more)[index] as Element)).toBe(text);
    const without = removed(text, node);
    expect(inserted(without, parentOf(without, node), number, copied(text, node))).toBe(text);
  }
});

/** The same parent in a text from which one of its children is gone: nothing before it has moved. */
const parentOf = (text: string, node: Element) =>
  [...everyElement(parse(text))].find((one) => one.from === node.parent?.from) as Element;

const SMALL = `<?xml version="1.0"?>
<!-- by hand -->
<root>
  <BehaviorTree ID="A">
    <Sequence name="top" odd='it&apos;s'>
      <!-- first -->
      <Action ID="X" name="a"/> <!-- of a -->
      <!-- second -->
      <Fallback name="b">
        <Action ID="Y" name="c" text="two
  lines"/>
      </Fallback>
      <Parallel name="d" />
    </Sequence>
  </BehaviorTree>
</root>
`;

test("a move takes an element with its own lines, and leaves comments of others", () => {
  const text = moved(SMALL, find(SMALL, "b"), find(SMALL, "d"), 0);
  expect(text).toContain(`      <!-- second -->
      <Parallel name="d">
          <Fallback name="b">
            <Action ID="Y" name="c" text="two
  lines"/>
          </Fallback>
      </Parallel>
    </Sequence>`);
  const back = moved(text, find(text, "b"), find(text, "top"), 1);
  expect(back).toContain(`      <Action ID="X" name="a"/> <!-- of a -->
      <Fallback name="b">
        <Action ID="Y" name="c" text="two
  lines"/>
      </Fallback>
      <!-- second -->`);
});

test("a move to where it is, or into itself, is none", () => {
  const [top, , b] = nodes(SMALL) as [Element, Element, Element];
  expect(moved(SMALL, b, top, 1)).toBe(SMALL);
  expect(moved(SMALL, b, top, 2)).toBe(SMALL);
  expect(moved(SMALL, top, b, 0)).toBe(SMALL);
});

test("a node is put around another", () => {
  const text = wrapped(SMALL, find(SMALL, "a"), '<Decorator ID="Z"/>');
  expect(text).toContain(`      <Decorator ID="Z">
          <Action ID="X" name="a"/>
      </Decorator> <!-- of a -->`);
});

test("values keep the quotes that they stand in, and lines end as in the text", () => {
  expect(withAttribute(SMALL, find(SMALL, "top"), "odd", `"'`)).toContain(`odd='"&apos;'`);
  expect(encoded(`"'`)).toBe("&quot;'");
  const windows = SMALL.replaceAll("\n", "\r\n");
  const more = inserted(windows, find(windows, "d"), 0, "<A>\n  <B/>\n</A>");
  expect(more.replaceAll("\r\n", "")).not.toContain("\n");
  expect(removed(more, find(more, "B"))).toContain("<A>\r\n          </A>");
});

test.each(["", "<a>", "<a></b>", "<a><b/>", "<a x=1/>", "<a/><b/>", "</a>", "<a x='<'/>", "<a", "<!DOCTYPE a><a/>"])(
  "%s is no XML",
  (text) => expect(() => parse(text)).toThrow(XmlError),
);
