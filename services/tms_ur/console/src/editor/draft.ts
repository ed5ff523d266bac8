// What a person draws: the text, what of it is chosen, and the way back.

export interface Draft {
  text: string;
  tree: string; // ID of the tree on the screen
  chosen: string; // path of a node, empty: none
}

export interface Drafts {
  past: Draft[];
  now: Draft;
  future: Draft[];
  stored: string; // the text as the database has it
}

const LIMIT = 200; // steps back

export const begun = (text: string, tree: string, stored: string): Drafts => ({
  past: [],
  now: { text, tree, chosen: "0" },
  future: [],
  stored,
});

/** One step: a new text, and what is chosen then. The same text is no step. */
export function edit(drafts: Drafts, next: Partial<Draft>): Drafts {
  const now = { ...drafts.now, ...next };
  if (now.text === drafts.now.text) {
    return { ...drafts, now };
  }
  return { ...drafts, past: [...drafts.past, drafts.now].slice(-LIMIT), now, future: [] };
}

export function undo(drafts: Drafts): Drafts {
  const before = drafts.past.at(-1);
  return before === undefined
    ? drafts
    : { ...drafts, past: drafts.past.slice(0, -1), now: before, future: [drafts.now, ...drafts.future] };
}

export function redo(drafts: Drafts): Drafts {
  const [next, ...future] = drafts.future;
  return next === undefined ? drafts : { ...drafts, past: [...drafts.past, drafts.now], now: next, future };
}

/** Whether something is drawn that is not stored. */
export const isChanged = (drafts: Drafts) => drafts.now.text !== drafts.stored;
