// Questions of WaitForClick nodes, above every page.

import { siteNow } from "old/server.js";
import { useTranslation } from "react-i18next";
import { Command } from "./command";
import { useLive } from "./live";
import type { Question } from "./models";
import { post } from "./server";

export function Questions() {
  const { state } = useLive();
  return (
    <div id="questions" role="alert">
      {state?.questions.map((asked) => (
        <Asked key={asked.id} asked={asked} />
      ))}
    </div>
  );
}

function Asked({ asked }: { asked: Question }) {
  const { t } = useTranslation();
  const reply = (yes: boolean) => async () => {
    await post("/api/questions/{question_id}", { yes }, { question_id: asked.id });
    return t("answered");
  };
  const left = asked.until ? Math.max(0, Math.round((Date.parse(asked.until) - siteNow()) / 1000)) : null;
  return (
    <section className="question">
      <strong>{asked.title || t("question")}</strong>
      <p>{asked.text}</p>
      <span>{left === null ? "" : t("seconds_left", { seconds: left })}</span>
      <Command className="go" work={reply(true)}>
        {t("yes")}
      </Command>
      <Command work={reply(false)}>{t("no")}</Command>
    </section>
  );
}
