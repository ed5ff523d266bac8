// The software stop: asks every gateway at once and says what was seen.
import { at, setText } from "./dom.js";
import { ask } from "./server.js";
import { t } from "./strings.js";

export async function stop(machine = "") {
  report(t("stopping_now"), true);
  try {
    const receipts = await ask("/api/stop", { machine });
    const told = receipts.map((one) => t(one.confirmed ? "stood" : "not_stood", one));
    report(`${told.join(" ")} ${t("stop_note")}`, receipts.some((one) => !one.confirmed));
  } catch (error) {
    report(error.message, true);
  }
}

function report(text, bad) {
  at("stop_report").className = bad ? "bad" : "good";
  setText(at("stop_report"), text);
}
