// The software stop: asks every gateway at once and says what was seen.
import { at, setText } from "./dom.js";
import { ask } from "./server.js";
import { said, t } from "./strings.js";

const AGAIN = 1000; // ms between attempts while the server cannot be reached
const LONGEST = 60_000; // ms of attempts: nobody expects a stop later than that
const ANSWER = 18_000; // ms; the server says after 13 s at the latest what the gateways saw
const SLOW = 5000; // ms; most machines were seen to stand by then
const OPEN = "tms.stop"; // kept until machines have answered: a session that ends meanwhile loads the page anew

export async function stop(machine = "") {
  const begun = performance.now();
  keepOpen(true);
  report(t("stopping_now"), true);
  const slow = setTimeout(() => report(t("stop_slow"), true), SLOW);
  let error = await attempt(machine);
  clearTimeout(slow);
  while (error?.unreachable && performance.now() - begun < LONGEST) {
    report(`${t("not_stopped", { reason: error.message })} ${t("stop_again")}`, true);
    await new Promise((resolve) => { setTimeout(resolve, AGAIN); });
    error = await attempt(machine);
  }
  if (error) {
    report(t("not_stopped", { reason: error.message }), true);
  }
}

/** One request; tells what was seen, or returns why nothing was. */
async function attempt(machine) {
  try {
    const receipts = await ask("/api/stop", { machine }, ANSWER);
    keepOpen(false);
    const seen = receipts.map((one) => t(one.confirmed ? "stood" : "not_stood", { ...one, detail: said(one.detail) }));
    report(`${seen.join(" ")} ${t("stop_note")}`, receipts.some((one) => !one.confirmed));
    return null;
  } catch (error) {
    return error;
  }
}

/** Says on a page that was loaded anew that the stop which was asked for before was not done. */
export function reportOpen(session) {
  if (isOpen()) {
    const loggedIn = session.name !== null;
    report(t("not_stopped", { reason: t(loggedIn ? "press_again" : "log_in_and_press") }), true);
    keepOpen(!loggedIn); // after the login once more, beside the button
  }
}

function isOpen() {
  try {
    return sessionStorage.getItem(OPEN) !== null;
  } catch {
    return false; // a browser may forbid storage
  }
}

function keepOpen(open) {
  try {
    if (open) {
      sessionStorage.setItem(OPEN, "1");
    } else {
      sessionStorage.removeItem(OPEN);
    }
  } catch {
    // not remembered then
  }
}

function report(text, bad) {
  at("stop_report").className = bad ? "bad" : "good";
  setText(at("stop_report"), text);
}
