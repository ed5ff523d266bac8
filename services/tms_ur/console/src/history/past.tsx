// The time line of one run: tree, machines, stops and journal at one cursor.
import { useEffect, useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Downloads } from "../downloads";
import { beginOf, countAt, endOf, type Journal } from "../journal/journal";
import { momentAfter } from "../journal/replay";
import { useJournal } from "../journal/use_journal";
import { useLive } from "../live";
import type { Run } from "../models";
import { Problem } from "../problem";
import { Said } from "../said";
import { clock } from "../texts";
import { Attempts } from "../tree/attempts";
import { TreeFlow } from "../tree/flow";
import type { TreeNode } from "../tree/shape";
import { spentIn } from "../tree/spent";
import { Cursor } from "./cursor";
import { Events, textOf } from "./events";
import { LaneView } from "./lane_view";
import { Motion } from "./motion";
import { RecordThen } from "./record_then";
import { recordedUntil } from "./recording";
import { RunLog } from "./run_log";
import { useRecording } from "./use_recording";

const FORMS = ["JSON", "CSV", "MCAP"];

interface Props {
  id: string;
  run: Run | undefined; // undefined: older than the list
  seconds: string; // of the moment that the address names, since the begin; empty: the end
}

export function Past({ id, run, seconds }: Props) {
  const { state } = useLive();
  const live = state?.runs.some((one) => one.run_id === id) ?? false;
  const { journal, error } = useJournal(id, live);
  return (
    <>
      <Problem id="past_problem" error={error} />
      {journal && <Line id={id} run={run} seconds={seconds} journal={journal} live={live} />}
    </>
  );
}

function Line({ id, run, seconds, journal, live }: Props & { journal: Journal; live: boolean }) {
  const { t } = useTranslation();
  const section = useRef<HTMLElement>(null);
  const [chosen, setChosen] = useState<number | null>(null); // null: the end, also while the run goes on
  const begin = beginOf(journal);
  useEffect(() => {
    const asked = seconds === "" ? Number.NaN : Number(seconds);
    setChosen(Number.isFinite(asked) ? begin + asked * 1000 : null);
  }, [seconds, begin]);
  useEffect(() => void section.current?.scrollIntoView(), []);
  const { recording, error } = useRecording(id, live);
  const end = useMemo(() => Math.max(endOf(journal), recordedUntil(recording)), [journal, recording]);
  const time = Math.min(chosen ?? end, end);
  return (
    <section id="past" ref={section}>
      <h2 id="past_title">{`${t("run")} ${id}`}</h2>
      <Values run={run} />
      <Downloads id="exports" label="export" files={FORMS.map((form) => [form, journalFile(id, form)])} />
      <Receipts journal={journal} onTime={setChosen} />
      <p id="journal_cut" className="bad">
        {journal.cut ? t("journal_cut", { number: journal.events.length }) : ""}
      </p>
      <div className="cursor">
        <Cursor run={id} journal={journal} end={end} time={time} onTime={setChosen} />
        <LaneView journal={journal} end={end} time={time} onTime={setChosen} />
      </div>
      <RunLog id={id} live={live} time={time} onTime={(moment) => setChosen(Math.max(begin, moment))} />
      <PastTree journal={journal} time={time} />
      <h3>{t("motion")}</h3>
      <Problem id="motion_problem" error={error} />
      {recording?.series.length === 0 && <p id="none_recorded">{t(live ? "none_recorded_yet" : "none_recorded")}</p>}
      {recording && recording.series.length > 0 && (
        <Motion run={id} first={run?.machines[0] ?? ""} recording={recording} time={time} onTime={setChosen} />
      )}
      <Events journal={journal} time={time} onTime={setChosen} />
    </section>
  );
}

function PastTree({ journal, time }: { journal: Journal; time: number }) {
  const count = countAt(journal, time);
  const moment = momentAfter(journal, count);
  const [shown, setShown] = useState(false);
  const spent = useMemo(() => (shown ? spentIn(journal, count, time) : null), [shown, journal, count, time]);
  const facts = (node: TreeNode) => (
    <>
      <RecordThen key={node.path} node={node} time={time} />
      <Attempts journal={journal} count={count} now={time} node={node} />
    </>
  );
  const timing = { shown, spent, onShow: setShown };
  return journal.tree && <TreeFlow tree={journal.tree} {...moment} facts={facts} timing={timing} />;
}

/** The further facts of the run that the scheduler has recorded. */
function Values({ run }: { run: Run | undefined }) {
  const { t } = useTranslation();
  const values = Object.entries(run?.values ?? {});
  if (values.length === 0) {
    return null;
  }
  return (
    <ul id="past_values" className="plain">
      {values.map(([name, value]) => (
        <li key={name}>{`${t(`f_${name}`, { defaultValue: name })}: ${value}`}</li>
      ))}
    </ul>
  );
}

function Receipts({ journal, onTime }: { journal: Journal; onTime: (time: number) => void }) {
  const { t } = useTranslation();
  const stops = journal.events.flatMap((event, index) => (event.kind === "stop" ? [{ event, index }] : []));
  return (
    <>
      <h3>{t("receipts")}</h3>
      <ul id="receipts" className="plain">
        {stops.length === 0 && <li>{t(journal.cut ? "no_receipts_yet" : "no_receipts")}</li>}
        {stops.map(({ event, index }) => (
          <li key={event.number}>
            <button type="button" className="plain_time" onClick={() => onTime(journal.times[index] ?? 0)}>
              {clock(event.stamp)}
            </button>{" "}
            <Said reason={event.reason} text={textOf(event)} />
          </li>
        ))}
      </ul>
    </>
  );
}

const journalFile = (run: string, form: string) =>
  `/api/runs/${encodeURIComponent(run)}/export?form=${form.toLowerCase()}`;
