// The text of a file; lines with findings are marked.
import type { Checked, Finding } from "../models";

const MAX_LINES = 2000; // lines that are shown
const MAX_WIDE = 500; // characters of a line

/** Shows a line of the text, from 1. */
export function toLine(line: number) {
  document.querySelector(`#source li:nth-child(${line})`)?.scrollIntoView({ block: "center" });
}

const linesOf = (found: Finding[] | undefined) => new Set(found?.map((one) => one.line));

export function Source({ xml, found }: { xml: string; found: Checked | null }) {
  const bad = linesOf(found?.errors);
  const warned = linesOf(found?.warnings);
  const mark = (line: number) => (bad.has(line) ? "errors" : warned.has(line) ? "warnings" : "");
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard scrolls it
    <ol id="source" className="source" tabIndex={0}>
      {xml.split("\n", MAX_LINES).map((line, index) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: lines have no other name
        <li key={index} className={mark(index + 1)}>
          {line.slice(0, MAX_WIDE) || " "}
        </li>
      ))}
    </ol>
  );
}
