// What is known now of a node of a run that goes on: its tries, the record of its goal and the flag that it reads, with
// values and age, and what it sees of the blackboard.
import { siteNow } from "old/server.js";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Age } from "../age";
import { listed, nameOf } from "../data/values";
import { useJournal } from "../journal/use_journal";
import { useLive } from "../live";
import type { Stored } from "../models";
import { Problem } from "../problem";
import { Said } from "../said";
import { get } from "../server";
import { said, timeOfDay } from "../texts";
import { Attempts } from "./attempts";
import { BlackboardNow } from "./blackboard_now";
import { port, type TreeNode } from "./shape";

const EVERY = 5000; // ms between looks at the record

export function LiveFacts({ run, node }: { run: string; node: TreeNode }) {
  const { journal, error } = useJournal(run, true);
  const record = port(node.ports, "record_name");
  const flag = port(node.ports, "mongo_record_name");
  return (
    <>
      <Waits run={run} node={node} />
      <Problem error={error} />
      {record && <RecordNow id="node_record" machine={node.machine} name={record} />}
      {flag && <RecordNow id="node_flag" machine="" name={flag} field={port(node.ports, "mongo_param_name")} />}
      <BlackboardNow run={run} node={node} />
      {journal && <Attempts journal={journal} count={journal.events.length} now={siteNow()} node={node} />}
    </>
  );
}

/** Why the leaf that works does not go on, and what helps. */
function Waits({ run: id, node }: { run: string; node: TreeNode }) {
  const { t } = useTranslation();
  const run = useLive().state?.runs.find((one) => one.run_id === id);
  if (!run?.reason || run.leaf !== node.path) {
    return null;
  }
  const since = run.reason_since ? ` (${t("since", { time: timeOfDay(run.reason_since, siteNow()) })})` : "";
  return (
    <p id="node_waits">
      <Said reason={run.reason} text={t("waits", { reason: said(run.reason) }) + since} />
    </p>
  );
}

interface RecordProps {
  id: string;
  machine: string; // empty: a record that all machines share
  name: string;
  field?: string; // the only one that is shown
}

function RecordNow({ id, machine, name, field = "" }: RecordProps) {
  const { t } = useTranslation();
  const [record, setRecord] = useState<Stored | null>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    const look = () =>
      get("/api/parameters", {}, `model_name=${encodeURIComponent(machine)}`).then(
        (found) => {
          setRecord(found.find((one) => one.record_name === name && one.model_name === machine) ?? null);
          setError(null);
        },
        (why: Error) => {
          setRecord(null); // the database is away: nothing is known of it
          setError(why);
        },
      );
    look();
    const timer = setInterval(look, EVERY);
    return () => clearInterval(timer);
  }, [machine, name]);
  const only = record && Object.entries(record.values).filter(([one]) => field === "" || one === field);
  if (error !== null) {
    return <Problem id={id} what={`${t("record")} ${name}`} error={error} />;
  }
  return (
    record && (
      <div id={id}>
        <h4>
          {t("record")} {nameOf(record)}
        </h4>
        <p>{listed(Object.fromEntries(only ?? []), record)}</p>
        <p className="small">
          {t("age")}: <Age stamp={record.updated_at} /> ({record.source})
        </p>
      </div>
    )
  );
}
