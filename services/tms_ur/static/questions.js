// Questions of WaitForClick nodes, with their buttons.
import { button, make, part, parts, setText } from "./dom.js";
import { once } from "./reasons.js";
import { ask, siteNow } from "./server.js";
import { t } from "./strings.js";

export function buildQuestion(asked) {
  const reply = (yes) => (event) => once(event.currentTarget, async () => {
    await ask(`/api/questions/${encodeURIComponent(asked.id)}`, { yes });
    return t("answered");
  });
  const answers = [button("yes", "go", reply(true)), button("no", "", reply(false))];
  answers.forEach((one) => { one.dataset.command = ""; }); // not for those who may only look
  return make("section", { className: "question" }, ...parts("strong", ["title"]), ...parts("p", ["text"]), ...parts("span", ["left"]), ...answers);
}

export function fillQuestion(box, asked) {
  setText(part(box, "title"), asked.title || t("question"));
  setText(part(box, "text"), asked.text);
  const left = asked.until && Math.max(0, Math.round((new Date(asked.until) - siteNow()) / 1000));
  setText(part(box, "left"), left === null ? "" : t("seconds_left", { seconds: left }));
}
