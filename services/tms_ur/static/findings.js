// Findings of a check with their lines.
import { make } from "./dom.js";
import { fillReason } from "./reasons.js";
import { t } from "./strings.js";

/** Shows the findings of a check with their lines. */
export function showFindings(box, found) {
  box.replaceChildren();
  if (found.errors.length + found.warnings.length === 0) {
    box.append(make("p", { className: "good" }, t("check_good")));
  }
  for (const kind of ["errors", "warnings"]) {
    if (found[kind].length > 0) {
      box.append(make("h3", {}, `${t(kind)} (${found[kind].length})`), make("ul", { className: kind },
        ...found[kind].map(buildFinding)));
    }
  }
}

function buildFinding({ line, reason }) {
  const row = make("li", { data: { line: line ?? "" } });
  fillReason(row, reason, { done: "edit_task" }); // the text of the task is on the screen
  return row;
}
