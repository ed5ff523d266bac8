// Reasons on the page: the text, the remedy as a button, a link or words, and details on request.
import { COMMANDS, LINKS } from "./actions.js";
import { at, make, say, setText } from "./dom.js";
import { said, sayAgain, t } from "./strings.js";

/** Shows a reason in `box`; `text` may embed its own text, and `done` is an action that has a button already. */
export function fillReason(box, reason, { text = said(reason), done = "" } = {}) {
  if (box === null) {
    return; // the page was left
  }
  const action = reason?.action && reason.action.name !== done ? reason.action : null;
  const shape = JSON.stringify([text === "", action, reason?.details]);
  if (box.dataset.shape !== shape) { // else the button keeps its focus at each new state
    box.dataset.shape = shape;
    box.replaceChildren(...(text === "" ? [] : [make("span"), ...help(action), ...details(reason)]));
    sayAgain(box);
  }
  setText(box.firstChild, text);
  box.querySelectorAll("summary").forEach((element) => setText(element, t("details")));
}

const texts = (both) => ({ said: JSON.stringify(both) });

function help(action) {
  if (action === null) {
    return [];
  }
  if (action.name in COMMANDS && Object.keys(action.args).length > 0) {
    const act = (event) => once(event.currentTarget, () => COMMANDS[action.name](action.args));
    return [" ", make("button", { type: "button", className: "go", onclick: act, data: { ...texts(action.text), command: "" } })];
  }
  if (action.name in LINKS) {
    return [" ", make("a", { className: "button", href: `/#${LINKS[action.name](action.args)}`, data: texts(action.text) })];
  }
  return [" ", make("span", { data: texts(action.text) })];
}

function details(reason) {
  if (!reason?.details.en) {
    return [];
  }
  return [" ", make("details", {}, make("summary"), make("span", { data: texts(reason.details) }))];
}

/** Shows why an action failed, or nothing for null; a page's own errors have no reason, only a text. */
export function showError(box, error) {
  if (box !== null) {
    fillReason(box, error?.reason ?? null, { text: error === null ? "" : error.message });
  }
}

export function sayError(error) {
  say("", true);
  const box = make("span");
  showError(box, error);
  at("message").replaceChildren(box);
}

/** Runs a command once: the button is disabled until the answer comes. `work` returns the text to show. */
export async function once(element, work) {
  if (element.disabled) {
    return;
  }
  element.disabled = true;
  say("");
  try {
    const text = await work();
    if (text) {
      say(text);
    }
  } catch (error) {
    sayError(error);
  } finally {
    element.disabled = false;
    if (document.activeElement === document.body) {
      element.focus(); // the disabled button has lost the focus
    }
  }
}
