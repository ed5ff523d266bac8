// The logs of all processes of a machine or a run in one, by time.
import { useCallback } from "react";
import { useTranslation } from "react-i18next";
import { LogNotes } from "../log_notes";
import { get } from "../server";
import { dateTime } from "../texts";
import { LogView } from "./log";

const MOST = 5000; // lines

/** `of` is the kind of what `name` names. */
export function MergedLog({ of, name }: { of: "machine" | "run"; name: string }) {
  const { t } = useTranslation();
  const read = useCallback(async () => {
    const key = of === "machine" ? "machine" : "run_id";
    const logs = await get("/api/logs", {}, `${key}=${encodeURIComponent(name)}&limit=${MOST}`);
    const text = logs.lines.map((line) => `${dateTime(line.time)} ${line.level} ${line.process} ${line.text}`);
    return { text: text.join("\n"), notes: <LogNotes logs={logs} /> };
  }, [of, name]);
  return <LogView label={t("log_of", { name })} read={read} />;
}
