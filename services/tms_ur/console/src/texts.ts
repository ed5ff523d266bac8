// The texts of the page, from the one table of both languages (words.js), and those that the server sends in both.
import { createInstance } from "i18next";
import { onLanguage, translatePage } from "old/strings.js";
import { WORDS } from "old/words.js";
import { initReactI18next } from "react-i18next";
import type { ReasonView } from "./models";

export type Language = "ja" | "en";

translatePage(); // chooses the language
const shown = (): Language => (document.documentElement.lang === "ja" ? "ja" : "en");

export const texts = createInstance();
texts.use(initReactI18next).init({
  lng: shown(),
  resources: { ja: { translation: WORDS.ja }, en: { translation: WORDS.en } },
  interpolation: { prefix: "{", suffix: "}", escapeValue: false }, // React escapes
  keySeparator: false,
  nsSeparator: false,
  initAsync: false,
});
onLanguage(() => texts.changeLanguage(shown()));

const LOCALES = { ja: "ja-JP", en: "en-GB" };
const locale = () => LOCALES[texts.language as Language];

/** The text of a reason in the present language; empty for none. */
export const said = (reason: ReasonView | null | undefined) => reason?.text[texts.language as Language] ?? "";

/** The time of day, without seconds; with the day where that is not `now`'s. */
export function timeOfDay(iso: string, now: number): string {
  const then = new Date(iso);
  const time: Intl.DateTimeFormatOptions = { hour: "2-digit", minute: "2-digit" };
  const day: Intl.DateTimeFormatOptions = { day: "numeric", month: "short" };
  const today = then.toDateString() === new Date(now).toDateString();
  return then.toLocaleString(locale(), today ? time : { ...day, ...time });
}

/** Date and time of day; a dash for none. */
export const dateTime = (iso: string | null | undefined) => (iso ? new Date(iso).toLocaleString(locale()) : "-");

const TENTHS: Intl.DateTimeFormatOptions = {
  hour: "2-digit",
  minute: "2-digit",
  second: "2-digit",
  fractionalSecondDigits: 1,
};

/** Time of day with tenths of a second, for events; a dash for none. */
export const clock = (iso: string | null | undefined) =>
  iso ? new Date(iso).toLocaleTimeString(locale(), TENTHS) : "-";
