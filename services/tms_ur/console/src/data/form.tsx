// The frame of what writes a record: an error is shown beside the button that led to it.
import { type ReactNode, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Command } from "../command";
import { Problem } from "../problem";
import { texts } from "../texts";

interface Props {
  title: string;
  save: () => Promise<string>; // resolves to the record's name
  onSaved: () => void;
  onClose: () => void;
  children: ReactNode;
}

export function RecordForm({ title, save, onSaved, onClose, children }: Props) {
  const { t } = useTranslation();
  const section = useRef<HTMLElement>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    section.current?.scrollIntoView();
    section.current?.querySelector("input")?.focus();
  }, []);
  const work = async () => {
    setError(null);
    try {
      const name = await save();
      onSaved();
      return texts.t("saved", { name });
    } catch (why) {
      setError(why as Error);
      return "";
    }
  };
  return (
    <section id="editor" ref={section}>
      <h2>{title}</h2>
      {children}
      <Problem id="editor_problem" error={error} />
      <div className="bar">
        <Command className="go" work={work}>
          {t("save")}
        </Command>
        <button type="button" onClick={onClose}>
          {t("close")}
        </button>
      </div>
    </section>
  );
}
