// The draft of a task. It stays while one looks at other pages, and the browser asks before the console is left with one.
import { useEffect, useState } from "react";
import { begun, type Drafts, isChanged } from "./draft";
import { mainOf, treesOf } from "./groot";
import type { Site, Target } from "./site";

const kept = new Map<string, Drafts>(); // by what stands in the address

/** Keeps the draft for another address, where it is stored now. */
export function keepAt(rest: string, before: string, drafts: Drafts) {
  kept.delete(before);
  kept.set(rest, { ...drafts, stored: drafts.now.text });
}

function first({ text, stored }: Target, { types }: Site): Drafts {
  const trees = treesOf(text, types);
  const main = trees.find((one) => one.id === mainOf(text)) ?? trees[0];
  return begun(text, main?.id ?? "", stored);
}

export function useDrafts(rest: string, target: Target, site: Site) {
  const [drafts, setDrafts] = useState(() => kept.get(rest) ?? first(target, site));
  useEffect(() => {
    kept.set(rest, drafts);
  }, [rest, drafts]);
  useEffect(() => {
    const leaving = (event: BeforeUnloadEvent) => {
      if ([...kept.values()].some((one) => isChanged(one) && one.past.length > 0)) {
        event.preventDefault();
      }
    };
    addEventListener("beforeunload", leaving);
    return () => removeEventListener("beforeunload", leaving);
  }, []);
  return [drafts, setDrafts] as const;
}
