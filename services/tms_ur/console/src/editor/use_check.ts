// The check of what is drawn, a moment after each change; the findings stay at their nodes until the next ones come.
import { useEffect, useMemo, useState } from "react";
import type { Checked, Finding } from "../models";
import { post } from "../server";
import { type At, linesOf, treesOf } from "./groot";
import type { Types } from "./palette";
import { XmlError } from "./xml";

const PAUSE = 200; // ms without a change

export interface Marks {
  errors: Finding[];
  warnings: Finding[];
}

export interface Check {
  found: Checked | null;
  error: Error | null; // why it could not be checked
  lines: Map<number, At>; // of the checked text
  marks: Map<string, Marks>; // by keyOf
}

export const keyOf = ({ tree, path }: At) => `${tree}\n${path}`;

/** Findings by the node on whose line they are. */
export function marksOf(found: Checked, lines: Map<number, At>): Map<string, Marks> {
  const marks = new Map<string, Marks>();
  for (const kind of ["errors", "warnings"] as const) {
    for (const one of found[kind]) {
      const at = one.line === null ? undefined : lines.get(one.line);
      if (at !== undefined) {
        const here = marks.get(keyOf(at)) ?? { errors: [], warnings: [] };
        here[kind].push(one);
        marks.set(keyOf(at), here);
      }
    }
  }
  return marks;
}

function linesIn(text: string, types: Types): Map<number, At> {
  try {
    return linesOf(text, treesOf(text, types));
  } catch (error) {
    if (error instanceof XmlError) {
      return new Map();
    }
    throw error;
  }
}

export function useCheck(text: string, types: Types): Check {
  const [checked, setChecked] = useState<{ found: Checked | null; error: Error | null; text: string } | null>(null);
  useEffect(() => {
    let left = false;
    const timer = setTimeout(() => {
      post("/api/tasks/check", { xml: text }).then(
        (found) => left || setChecked({ found, error: null, text }),
        (error: Error) => left || setChecked({ found: null, error, text }),
      );
    }, PAUSE);
    return () => {
      left = true;
      clearTimeout(timer);
    };
  }, [text]);
  return useMemo(() => {
    const lines = checked === null ? new Map<number, At>() : linesIn(checked.text, types);
    const found = checked?.found ?? null;
    return { found, error: checked?.error ?? null, lines, marks: found === null ? new Map() : marksOf(found, lines) };
  }, [checked, types]);
}
