// The log lines of a run up to the cursor: of its machines' processes and the scheduler. A line puts the cursor there.
// They are in English and name what ROS has, for whoever looks for a fault: shown, and read, on request.
import { useEffect, useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { LogNotes } from "../log_notes";
import type { Logs } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { clock } from "../texts";
import { gravityOf, linesUpTo, type Row, rowsOf } from "./log_lines";

const MOST = 10_000; // lines that are read
const SHOWN = 50;
const MARKS = { "": "", warning: "▲ ", critical: "⬣ " };

interface Props {
  id: string;
  live: boolean; // the run goes on: its log is read again when it has ended
  time: number; // ms, of the cursor
  onTime: (time: number) => void;
}

export function RunLog(props: Props) {
  const { t } = useTranslation();
  const [open, setOpen] = useState(false);
  return (
    <details id="run_log" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>{t("run_log")}</summary>
      {open && <Log {...props} />}
    </details>
  );
}

function Log({ id, live, time, onTime }: Props) {
  const { t } = useTranslation();
  const { logs, error } = useLogs(id, live);
  const rows = useMemo(() => rowsOf(logs?.lines ?? []), [logs]);
  const shown = linesUpTo(rows, time, SHOWN);
  return (
    <>
      <Problem id="run_log_problem" error={error} />
      {logs !== null && <LogNotes logs={logs} />}
      {rows.length > 0 && shown.length === 0 && <p>{t("no_lines_yet")}</p>}
      <Lines rows={shown} onTime={onTime} />
    </>
  );
}

function Lines({ rows, onTime }: { rows: Row[]; onTime: (time: number) => void }) {
  const box = useRef<HTMLOListElement>(null);
  const last = rows.at(-1)?.key;
  // biome-ignore lint/correctness/useExhaustiveDependencies: the line at the cursor is in sight whenever it is another
  useEffect(() => {
    if (box.current !== null) {
      box.current.scrollTop = box.current.scrollHeight;
    }
  }, [last]);
  return (
    <ol ref={box} className="log_lines" hidden={rows.length === 0}>
      {rows.map(({ key, time, line }) => (
        <li key={key}>
          <button type="button" className={`log_line ${gravityOf(line)}`} onClick={() => onTime(time)}>
            {`${clock(line.time)} ${MARKS[gravityOf(line)]}${line.level} ${line.process} ${line.text}`}
          </button>
        </li>
      ))}
    </ol>
  );
}

function useLogs(id: string, live: boolean): { logs: Logs | null; error: Error | null } {
  const [logs, setLogs] = useState<Logs | null>(null);
  const [error, setError] = useState<Error | null>(null);
  // biome-ignore lint/correctness/useExhaustiveDependencies: read again when the run has ended
  useEffect(() => {
    let wanted = true; // not when the page was left meanwhile
    const took = (found: Logs | null, why: Error | null) => {
      if (wanted) {
        setLogs((before) => found ?? before);
        setError(why);
      }
    };
    get("/api/logs", {}, `run_id=${encodeURIComponent(id)}&limit=${MOST}`).then(
      (found) => took(found, null),
      (why: Error) => took(null, why),
    );
    return () => {
      wanted = false;
    };
  }, [id, live]);
  return { logs, error };
}
