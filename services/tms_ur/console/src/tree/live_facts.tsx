// What is known now of a node of a run that goes on: its tries, and the record of its goal with values and age.
import { siteNow } from "old/server.js";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Age } from "../age";
import { listed, nameOf } from "../data/values";
import { useJournal } from "../journal/use_journal";
import type { Stored } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { Attempts } from "./attempts";
import { port, type TreeNode } from "./shape";

const EVERY = 5000; // ms between looks at the record

export function LiveFacts({ run, node }: { run: string; node: TreeNode }) {
  const { journal, error } = useJournal(run, true);
  const record = port(node.ports, "record_name");
  return (
    <>
      <Problem error={error} />
      {record && <RecordNow machine={node.machine} name={record} />}
      {journal && <Attempts journal={journal} count={journal.events.length} now={siteNow()} node={node} />}
    </>
  );
}

function RecordNow({ machine, name }: { machine: string; name: string }) {
  const { t } = useTranslation();
  const [record, setRecord] = useState<Stored | null>(null);
  useEffect(() => {
    const look = () =>
      get("/api/parameters", {}, `model_name=${encodeURIComponent(machine)}`).then(
        (found) => setRecord(found.find((one) => one.record_name === name) ?? null),
        () => setRecord(null), // the database is away: nothing is known of it
      );
    look();
    const timer = setInterval(look, EVERY);
    return () => clearInterval(timer);
  }, [machine, name]);
  return (
    record && (
      <div id="node_record">
        <h4>
          {t("record")} {nameOf(record)}
        </h4>
        <p>{listed(record.values, record)}</p>
        <p className="small">
          {t("age")}: <Age stamp={record.updated_at} /> ({record.source})
        </p>
      </div>
    )
  );
}
