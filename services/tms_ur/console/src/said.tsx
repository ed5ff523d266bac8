// A reason on the page: its text, what helps as a button, a link or words, and details on request.

import { COMMANDS, LINKS } from "old/actions.js";
import { useTranslation } from "react-i18next";
import { Command } from "./command";
import type { ReasonView } from "./models";
import { may } from "./role";
import type { Language } from "./texts";

interface Props {
  reason: ReasonView | null | undefined;
  text?: string | undefined; // that embeds the reason's own
  done?: string | undefined; // action that has a button already
}

export function Said({ reason, text, done }: Props) {
  const { i18n, t } = useTranslation();
  const language = i18n.language as Language;
  const shown = text ?? reason?.text[language] ?? "";
  if (shown === "") {
    return null;
  }
  const action = reason?.action && reason.action.name !== done ? reason.action : null;
  return (
    <>
      <span>{shown}</span> {action && <Help action={action} language={language} />}
      {reason?.details.en && (
        <details>
          <summary>{t("details")}</summary>
          <span>{reason.details[language]}</span>
        </details>
      )}
    </>
  );
}

function Help({ action, language }: { action: NonNullable<ReasonView["action"]>; language: Language }) {
  const text = action.text[language];
  const command = COMMANDS[action.name];
  const link = LINKS[action.name];
  if (command !== undefined && Object.keys(action.args).length > 0 && may("operator")) {
    return (
      <Command className="go" work={() => command(action.args)}>
        {text}
      </Command>
    );
  }
  if (link !== undefined) {
    return (
      <a className="button" href={`#${link(action.args)}`}>
        {text}
      </a>
    );
  }
  return <span>{text}</span>; // what people do with their hands, or another person may do
}
