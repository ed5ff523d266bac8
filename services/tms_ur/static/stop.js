// The software stop: calls every gateway at the same time and shows the receipts.
import { at, setText } from "./dom.js";
import { ask } from "./server.js";
import { said, t } from "./strings.js";

const AGAIN = 1000; // ms between attempts while the server cannot be reached
const LONGEST = 60_000; // ms of attempts: the operator does not expect a stop later than that
const ANSWER = 18_000; // ms; the server answers after 13 s at the latest
const SLOW = 5000; // ms; most receipts have come by then
const OPEN = "tms.stop"; // kept until the receipts come, since the page is loaded anew when the session ends meanwhile

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

/** Makes one request; shows the receipts, or returns the error. */
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

/** Shows on a page that was loaded anew that the earlier stop was not done. */
export function reportOpen(session) {
  if (isOpen()) {
    const loggedIn = session.name !== null;
    report(t("not_stopped", { reason: t(loggedIn ? "press_again" : "log_in_and_press") }), true);
    keepOpen(!loggedIn); // without a login keep it: it is shown again after the login, beside the button
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
