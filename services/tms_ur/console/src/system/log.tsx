// The end of a process's log, searched; it is read anew on request.
import { useCallback, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Problem } from "../problem";
import { get } from "../server";

const MOST = 200_000; // bytes, as the server gives at most

export function ProcessLog({ name }: { name: string }) {
  const { t } = useTranslation();
  const [text, setText] = useState("");
  const [error, setError] = useState<Error | null>(null);
  const [words, setWords] = useState("");
  const box = useRef<HTMLPreElement>(null);
  const read = useCallback(() => {
    get("/api/processes/{name}/log", { name }, `size=${MOST}`).then(
      (found) => {
        setText(found.text);
        setError(null);
      },
      (why: Error) => setError(why),
    );
  }, [name]);
  useEffect(read, [read]);
  const shown = linesWith(text, words);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the newest line is in sight whenever others are shown
  useEffect(() => void box.current?.scrollTo(0, box.current.scrollHeight), [shown]);
  useEffect(() => void box.current?.scrollIntoView({ block: "nearest" }), []);
  return (
    <section id="log" aria-label={t("log_of", { name })}>
      <div className="bar">
        <label>
          {t("filter")}
          <input id="log_filter" type="search" value={words} onChange={(event) => setWords(event.target.value)} />
        </label>
        <button type="button" onClick={read}>
          {t("read_again")}
        </button>
      </div>
      <Problem error={error} />
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard scrolls it */}
      <pre id="log_text" ref={box} tabIndex={0}>
        {shown}
      </pre>
    </section>
  );
}

/** The lines of a text that hold all of some words: a run, a goal, a machine. */
export function linesWith(text: string, words: string): string {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const lines = text.split("\n");
  return lines.filter((line) => wanted.every((word) => line.toLowerCase().includes(word))).join("\n");
}
