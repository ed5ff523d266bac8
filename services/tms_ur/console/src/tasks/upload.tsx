// A file from Groot: its check, what differs from a stored task, its text, and storing it.
import { say } from "old/dom.js";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Findings } from "../findings";
import type { Checked, Task } from "../models";
import { Problem } from "../problem";
import { post } from "../server";
import { Compare } from "./compare";
import { Source, toLine } from "./source";
import { StoreForm } from "./store_form";

const MAX_BYTES = 5_000_000; // same limit as in the server

export interface Given {
  name: string; // of the file
  xml: string;
}

export function Upload({ stored, changed }: { stored: Task[]; changed: () => void }) {
  const { t } = useTranslation();
  const [given, setGiven] = useState<Given | null>(null);
  const [found, setFound] = useState<Checked | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const check = async (one: Given) => {
    try {
      setFound(await post("/api/tasks/check", { xml: one.xml }));
      setError(null);
    } catch (why) {
      setFound(null);
      setError(why as Error);
    }
  };
  const read = async (file: File | undefined) => {
    if (file === undefined) {
      return;
    }
    say("");
    setGiven(null);
    setFound(null);
    if (file.size > MAX_BYTES) {
      setError(new Error(t("too_large", { name: file.name })));
      return;
    }
    const one = { name: file.name, xml: await file.text() };
    setGiven(one);
    await check(one);
  };
  return (
    <>
      <h2>{t("upload")}</h2>
      <label>
        {t("upload")}
        <input
          type="file"
          id="file"
          accept=".xml,text/xml"
          onClick={(event) => {
            event.currentTarget.value = ""; // the same file, corrected where it is, counts as chosen again
          }}
          onChange={(event) => read(event.target.files?.[0])}
        />
      </label>
      <div id="findings" role="status">
        <Problem error={error} />
        {found && <Findings found={found} onLine={toLine} />}
      </div>
      {given && (
        <section id="chosen">
          <button type="button" onClick={() => check(given)}>
            {t("check_again")}
          </button>
          <StoreForm given={given} found={found} changed={changed} />
          <Compare given={given} stored={stored} />
          <h3>{t("file_text")}</h3>
          <Source xml={given.xml} found={found} />
        </section>
      )}
    </>
  );
}
