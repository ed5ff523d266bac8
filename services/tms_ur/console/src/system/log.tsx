// The end of a log, searched; it is read anew on request.
import { type ReactNode, useCallback, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Problem } from "../problem";
import { get } from "../server";

const MOST = 200_000; // bytes, as the server gives at most

export interface Found {
  text: string;
  notes?: ReactNode; // what is not in it
}

interface Props {
  label: string;
  read: () => Promise<Found>; // must not change from one drawing to the next
}

export function LogView({ label, read }: Props) {
  const { t } = useTranslation();
  const [{ text, notes }, setFound] = useState<Found>({ text: "" });
  const [error, setError] = useState<Error | null>(null);
  const [words, setWords] = useState("");
  const box = useRef<HTMLPreElement>(null);
  const again = useCallback(() => {
    read().then(
      (found) => {
        setFound(found);
        setError(null);
      },
      (why: Error) => setError(why),
    );
  }, [read]);
  useEffect(again, [again]);
  const shown = linesWith(text, words);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the newest line is in sight whenever others are shown
  useEffect(() => void box.current?.scrollTo(0, box.current.scrollHeight), [shown]);
  useEffect(() => void box.current?.scrollIntoView({ block: "nearest" }), []);
  return (
    <section id="log" aria-label={label}>
      <div className="bar">
        <label>
          {t("filter")}
          <input id="log_filter" type="search" value={words} onChange={(event) => setWords(event.target.value)} />
        </label>
        <button type="button" onClick={again}>
          {t("read_again")}
        </button>
      </div>
      <Problem error={error} />
      {notes}
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard scrolls it */}
      <pre id="log_text" ref={box} tabIndex={0}>
        {shown}
      </pre>
    </section>
  );
}

export function ProcessLog({ name }: { name: string }) {
  const { t } = useTranslation();
  const read = useCallback(() => get("/api/processes/{name}/log", { name }, `size=${MOST}`), [name]);
  return <LogView label={t("log_of", { name })} read={read} />;
}

/** The lines of a text that hold all of some words: a run, a goal, a machine. */
export function linesWith(text: string, words: string): string {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const lines = text.split("\n");
  return lines.filter((line) => wanted.every((word) => line.toLowerCase().includes(word))).join("\n");
}
