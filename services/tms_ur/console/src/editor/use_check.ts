// The check of what is drawn, after each change; the findings stay at their nodes until the next ones come.
// To plan the motions takes seconds: the check with them comes once nothing has changed for a moment.
import { useEffect, useMemo, useRef, useState } from "react";
import type { Checked, Finding } from "../models";
import { post } from "../server";
import { type At, linesOf, treesOf } from "./groot";
import type { Types } from "./palette";
import { XmlError } from "./xml";

const PAUSE = 1000; // ms without a change

export interface Marks {
  errors: Finding[];
  warnings: Finding[];
}

export interface Check {
  found: Checked | null;
  error: Error | null; // why it could not be checked
  fresh: boolean; // it is of the text as it is now
  planning: boolean; // the motions of that text are not planned yet
  lines: Map<number, At>; // of the checked text
  marks: Map<string, Marks>; // by keyOf
}

/** What the server said of a text. */
interface Answer {
  found: Checked | null;
  error: Error | null;
  text: string;
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

interface Checking {
  newest: string; // text
  busy: boolean; // the server has been asked
  left: boolean; // nobody waits any more
}

function checked(text: string, motions: boolean): Promise<Answer> {
  const asked = { found: null, error: null, text };
  return post("/api/tasks/check", { xml: text }, {}, `motions=${motions}`).then(
    (found): Answer => ({ ...asked, found }),
    (error: Error): Answer => ({ ...asked, error }),
  );
}

/** Asks for one quick check after another until the newest text is checked: those in between are left out. */
async function follow(now: Checking, tell: (checked: Answer) => void) {
  now.busy = true;
  let text: string | null = null;
  while (text !== now.newest && !now.left) {
    text = now.newest;
    const answer = await checked(text, false);
    if (!now.left) {
      tell(answer);
    }
  }
  now.busy = false;
}

export function useCheck(text: string, types: Types): Check {
  const [quick, setQuick] = useState<Answer | null>(null);
  const [whole, setWhole] = useState<Answer | null>(null);
  const checking = useRef<Checking>({ newest: text, busy: false, left: false });
  useEffect(() => {
    const now = checking.current;
    now.left = false;
    return () => {
      now.left = true;
    };
  }, []);
  useEffect(() => {
    checking.current.newest = text;
    if (!checking.current.busy) {
      follow(checking.current, setQuick);
    }
  }, [text]);
  const fresh = quick?.text === text;
  useEffect(() => {
    if (!fresh) {
      return;
    }
    let left = false;
    const take = (answer: Answer) => left || setWhole(answer);
    const timer = window.setTimeout(() => checked(text, true).then(take), PAUSE);
    return () => {
      left = true;
      clearTimeout(timer);
    };
  }, [text, fresh]);
  const answer = whole?.text === quick?.text ? whole : quick;
  const shown = useMemo(() => {
    const lines = answer === null ? new Map<number, At>() : linesIn(answer.text, types);
    const found = answer?.found ?? null;
    return { found, error: answer?.error ?? null, lines, marks: found === null ? new Map() : marksOf(found, lines) };
  }, [answer, types]);
  return { ...shown, fresh, planning: fresh && whole?.text !== text };
}
