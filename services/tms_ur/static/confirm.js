// The dialog of the panel: it names what happens, and has the software stop in it.
import { at, confirmWith } from "./dom.js";
import { stop } from "./stop.js";

let answer = null; // of the question that is open

/** Asks with a text or elements; resolves to false where another question is open, so that one answer never counts for two. */
export function askInDialog(...content) {
  if (answer !== null) {
    return Promise.resolve(false);
  }
  const dialog = at("dialog");
  at("dialog_text").replaceChildren(...content);
  dialog.returnValue = "no";
  dialog.showModal();
  return new Promise((resolve) => {
    answer = resolve;
  });
}

export function prepareDialog() {
  confirmWith(askInDialog);
  at("dialog").addEventListener("close", (event) => {
    const { returnValue } = event.currentTarget;
    answer?.(returnValue === "yes");
    answer = null;
    if (returnValue === "stop") {
      stop();
    }
  });
}
