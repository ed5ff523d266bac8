// Asks for confirmation. The browser's own dialog keeps focus and keys inside; those of component libraries lock the
// page's scrolling by a style element of their own, which the policy of the site refuses.

import { confirmWith } from "old/dom.js";
import { stop } from "old/stop.js";
import { type ReactNode, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";

interface Question {
  content: ReactNode;
  answer: (yes: boolean) => void;
}

let put: ((question: Question) => boolean) | null = null;

/** Asks; resolves to false where another question is open, so that one answer never counts for two. */
export function confirmed(content: ReactNode): Promise<boolean> {
  return new Promise((answer) => {
    if (!put?.({ content, answer })) {
      answer(false);
    }
  });
}
confirmWith(confirmed);

export function Confirm() {
  const { t } = useTranslation();
  const dialog = useRef<HTMLDialogElement>(null);
  const open = useRef<Question | null>(null);
  const [content, setContent] = useState<ReactNode>(null);
  useEffect(() => {
    put = (question) => {
      if (open.current !== null) {
        return false;
      }
      open.current = question;
      setContent(question.content);
      if (dialog.current !== null) {
        dialog.current.returnValue = "no";
        dialog.current.showModal();
      }
      return true;
    };
    return () => {
      put = null;
    };
  }, []);
  const closed = () => {
    const question = open.current;
    open.current = null;
    question?.answer(dialog.current?.returnValue === "yes");
    if (dialog.current?.returnValue === "stop") {
      stop();
    }
  };
  return (
    <dialog id="dialog" ref={dialog} onClose={closed} aria-labelledby="dialog_text">
      <div id="dialog_text">{content}</div>
      <form method="dialog" className="bar">
        <button type="submit" value="stop" className="stop" id="dialog_stop">
          {t("stop")}
        </button>
        {/* biome-ignore lint/a11y/noAutofocus: of a dialog, the answer that changes nothing */}
        <button type="submit" value="no" autoFocus>
          {t("cancel_dialog")}
        </button>
        <button type="submit" value="yes" className="go" id="dialog_yes">
          {t("confirm")}
        </button>
      </form>
    </dialog>
  );
}
