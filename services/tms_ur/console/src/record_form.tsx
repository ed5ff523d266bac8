// The frame of what writes a record: an error is shown beside the button that led to it.
import { type ReactNode, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "./command";
import { Problem } from "./problem";
import { texts } from "./texts";

interface Props {
  id: string;
  title: string;
  jump?: boolean; // the page goes to it at once
  save: (() => Promise<string>) | null; // resolves to MACHINE/RECORD; null: what is told cannot be saved yet
  onSaved: (name: string) => void;
  onClose: () => void;
  children: ReactNode;
}

export function RecordForm({ id, title, jump = false, save, onSaved, onClose, children }: Props) {
  const { t } = useTranslation();
  const section = useRef<HTMLElement>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    if (jump) {
      section.current?.scrollIntoView();
      section.current?.querySelector("input")?.focus();
    }
  }, [jump]);
  const work = (write: () => Promise<string>) => async () => {
    setError(null);
    try {
      const name = await write();
      onSaved(name);
      return texts.t("saved", { name });
    } catch (why) {
      setError(why as Error);
      return "";
    }
  };
  return (
    <section id={id} className="card" aria-label={title} ref={section}>
      <h3>{title}</h3>
      {children}
      <Problem id={`${id}_problem`} error={error} />
      <div className="bar">
        {save && (
          <Command className="go" needs="admin" work={work(save)}>
            {t("save")}
          </Command>
        )}
        <button type="button" onClick={onClose}>
          {t("close")}
        </button>
      </div>
    </section>
  );
}
