// The language of the page: texts, dates, and the callbacks at its change.
import { WORDS } from "./words.js";

const KEPT = "tms.language";
const listeners = [];
let language = remembered() ?? (navigator.language.startsWith("ja") ? "ja" : "en");

function remembered() {
  try {
    const kept = localStorage.getItem(KEPT);
    return kept in WORDS ? kept : null;
  } catch {
    return null; // a browser may forbid storage; the switch still works for this page
  }
}

/** A text in the present language with {name} filled in; an unknown key is shown as it is. */
export function t(key, values = {}) {
  const text = WORDS[language][key] ?? key;
  return text.replace(/\{(\w+)\}/g, (_, name) => String(values[name] ?? ""));
}

/** The present language's text among those that the server sends. */
export const inLanguage = (texts) => texts[language];

/** The text of a reason; empty for none. */
export const said = (reason) => (reason ? inLanguage(reason.text) : "");

/** Date and time in the format of the language. */
export function when(iso) {
  return iso ? new Date(iso).toLocaleString(language === "ja" ? "ja-JP" : "en-GB") : "-";
}

/** Writes anew the texts that the server has sent in every language: elements with data-said in a part of the page. */
export function sayAgain(part) {
  for (const element of part.querySelectorAll("[data-said]")) {
    element.textContent = inLanguage(JSON.parse(element.dataset.said));
  }
}

/** Writes anew the texts of the page itself (elements with data-t) and those that the server has sent. */
export function translatePage() {
  document.documentElement.lang = language;
  document.title = `${t("title")} - ROS2-TMS`;
  for (const element of document.querySelectorAll("[data-t]")) {
    element.textContent = t(element.dataset.t);
  }
  for (const element of document.querySelectorAll("[data-label]")) {
    element.setAttribute("aria-label", t(element.dataset.label));
  }
  sayAgain(document);
}

export function onLanguage(listener) {
  listeners.push(listener);
}

export function switchLanguage() {
  language = language === "ja" ? "en" : "ja";
  try {
    localStorage.setItem(KEPT, language);
  } catch {
    // not remembered then
  }
  translatePage();
  listeners.forEach((listener) => listener());
}
