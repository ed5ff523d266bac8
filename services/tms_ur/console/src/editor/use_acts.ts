// What the buttons, keys and drags of the editor do to its draft.
import { say } from "old/dom.js";
import { type Dispatch, type SetStateAction, useState } from "react";
import { texts } from "../texts";
import { add, copy, move, remove, setAttribute, step, type Where } from "./acts";
import { type Draft, type Drafts, edit, redo, undo } from "./draft";
import { type EditNode, type EditTree, neighbour } from "./groot";
import type { Act } from "./keys";
import type { Types } from "./palette";

interface Now {
  drafts: Drafts;
  setDrafts: Dispatch<SetStateAction<Drafts>>;
  tree: EditTree | undefined;
  node: EditNode | undefined; // that is chosen
  types: Types;
}

export function useActs({ drafts, setDrafts, tree, node, types }: Now) {
  const [clip, setClip] = useState(""); // text of the copied node
  const take = (next: Partial<Draft> | null) => {
    say(next === null ? texts.t("ed_no_room") : "");
    if (next !== null) {
      setDrafts((now) => edit(now, next));
    }
  };
  const put = (source: string, at: EditNode | undefined, where: Where) => {
    if (tree !== undefined) {
      take(add(drafts.now, tree, at ?? tree.root ?? undefined, where, source, types));
    }
  };
  const withNode = (one: EditNode, shown: EditTree): Partial<Record<Act, () => void>> => ({
    copy: () => setClip(copy(drafts.now, one)),
    cut: () => {
      setClip(copy(drafts.now, one));
      take(remove(drafts.now, shown, one));
    },
    remove: () => take(remove(drafts.now, shown, one)),
    earlier: () => take(step(drafts.now, shown, one, "earlier")),
    later: () => take(step(drafts.now, shown, one, "later")),
    out: () => take(step(drafts.now, shown, one, "out")),
    in: () => take(step(drafts.now, shown, one, "in")),
    form: () => document.querySelector<HTMLInputElement>("#ed_form input")?.focus(),
  });
  const look = (way: "up" | "down" | "left" | "right") => () => {
    if (tree !== undefined) {
      take({ chosen: neighbour(tree, drafts.now.chosen, way) });
    }
  };
  const acts: Partial<Record<Act, () => void>> = {
    ...(drafts.past.length > 0 && { undo: () => setDrafts(undo) }),
    ...(drafts.future.length > 0 && { redo: () => setDrafts(redo) }),
    ...(clip !== "" && { paste: () => put(clip, node, "inside") }),
    ...(node && tree && withNode(node, tree)),
    up: look("up"),
    down: look("down"),
    left: look("left"),
    right: look("right"),
  };
  return {
    acts,
    take,
    put,
    set: (name: string, value: string) => node && take(setAttribute(drafts.now, node, name, value)),
    drop: (what: { path: string } | { source: string }, path: string, where: Where) => {
      const at = tree?.nodes.get(path);
      const moving = "path" in what ? tree?.nodes.get(what.path) : undefined;
      if ("source" in what) {
        put(what.source, at, where);
      } else if (tree && moving && at) {
        take(move(drafts.now, tree, moving, at, where));
      }
    },
  };
}
