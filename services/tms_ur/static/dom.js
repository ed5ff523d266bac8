// Building blocks of the panel, and what the pages share with it.
import { t } from "./strings.js";

const MARKS = { moving: "▶", running: "▶", RUNNING: "▶", standing: "■", success: "✔", STOPPED: "■", on_demand: "■", stopping: "…",
  preparing: "…", STARTING: "…", STOPPING: "…", armed: "✔", held: "…",
  alive: "✔", waiting: "…", place_free: "✔", place_granted: "…", place_held: "■", place_leaving: "…" };
const GOOD = new Set(["moving", "standing", "running", "success", "RUNNING", "armed", "alive", "place_held"]);
const CALM = new Set(["STOPPED", "on_demand", "EXITED", "place_free", "place_granted", "place_leaving", "cancelled", "preparing", "stopping", "STARTING", "STOPPING", "held", "by_hand", "waiting"]);

export const at = (id) => document.getElementById(id);

/** A new element; text is inserted as text only, so stored values cannot become markup. */
export function make(tag, options = {}, ...children) {
  const { data, label, ...properties } = options;
  const element = Object.assign(document.createElement(tag), properties);
  Object.assign(element.dataset, data);
  if (label !== undefined) {
    element.setAttribute("aria-label", label);
  }
  element.append(...children);
  return element;
}

/** Keeps one child per item, in order, and reuses it, so that buttons keep their focus at each new state. */
export function keep(parent, items, key, build, fill) {
  const old = new Map([...parent.children].map((child) => [child.dataset.key, child]));
  items.forEach((item, index) => {
    const name = String(key(item));
    const child = old.get(name) ?? build(item);
    child.dataset.key = name;
    old.delete(name);
    fill(child, item);
    if (parent.children[index] !== child) {
      parent.insertBefore(child, parent.children[index] ?? null);
    }
  });
  old.forEach((child) => child.remove());
}

/** Sets a text; `element` is null when an answer comes after its page was left. */
export function setText(element, text) {
  if (element !== null && element.textContent !== text) {
    element.textContent = text;
  }
}

export const mark = (state) => MARKS[state] ?? "!";

export const tone = (state) => (GOOD.has(state) ? "good" : CALM.has(state) ? "calm" : "bad");

export function part(element, name) {
  return element.querySelector(`[data-part="${name}"]`);
}

export function parts(tag, names) {
  return names.map((name) => make(tag, { data: { part: name } }));
}

/** A button whose text and spoken name follow the language: `text` and `label` are [key, values]. */
export function button(text, className, onclick, label = text) {
  const element = make("button", { type: "button", className, onclick });
  element.relabel = () => {
    setText(element, t(...[text].flat()));
    element.setAttribute("aria-label", t(...[label].flat()));
  };
  element.dataset.relabel = "";
  element.relabel();
  return element;
}

export function relabelAll() {
  document.querySelectorAll("[data-relabel]").forEach((element) => element.relabel());
}

export function duration(seconds) {
  if (seconds === null) {
    return t("never");
  }
  if (seconds < 120) {
    return `${seconds.toFixed(seconds < 10 ? 1 : 0)} s`;
  }
  return seconds < 7200 ? `${Math.floor(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

export function say(text, bad = false) {
  at("message").className = bad ? "bad" : "good";
  setText(at("message"), text);
}

let question = null; // shows a text and resolves to whether it was confirmed

/** Gives pages the frame's dialog. */
export function confirmWith(ask) {
  question = ask;
}

/** Asks for confirmation of a step that cannot be undone; resolves to true or false. */
export const confirmed = (text) => question(text);
