// Keys of the picture.

export type Act =
  | "up"
  | "down"
  | "left"
  | "right"
  | "earlier"
  | "later"
  | "in"
  | "out"
  | "copy"
  | "cut"
  | "paste"
  | "remove"
  | "undo"
  | "redo"
  | "form";

const PLAIN: Record<string, Act> = {
  ArrowUp: "up",
  ArrowDown: "down",
  ArrowLeft: "left",
  ArrowRight: "right",
  Delete: "remove",
  Backspace: "remove",
  Enter: "form",
};
const ALT: Record<string, Act> = { ArrowUp: "out", ArrowDown: "in", ArrowLeft: "earlier", ArrowRight: "later" };
const CONTROL: Record<string, Act> = { c: "copy", x: "cut", v: "paste", z: "undo", y: "redo" };

interface Key {
  key: string;
  altKey: boolean;
  ctrlKey: boolean;
  metaKey: boolean;
  shiftKey: boolean;
}

/** What a key asks for. */
export function actOf({ key, altKey, ctrlKey, metaKey, shiftKey }: Key): Act | undefined {
  if (ctrlKey || metaKey) {
    const act = CONTROL[key.toLowerCase()];
    return act === "undo" && shiftKey ? "redo" : act;
  }
  return altKey ? ALT[key] : PLAIN[key];
}
