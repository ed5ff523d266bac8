// The record of a leaf's goal as it was at the cursor, as far as its history goes back.
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { listed } from "../data/values";
import type { RecordChange } from "../models";
import { get } from "../server";
import { dateTime } from "../texts";
import { port, type TreeNode } from "../tree/shape";
import { valuesThen } from "./values_then";

const KEPT = 200; // changes, as many as the server gives

export function RecordThen({ node, time }: { node: TreeNode; time: number }) {
  const { t } = useTranslation();
  const [changes, setChanges] = useState<RecordChange[] | null>(null);
  const { machine, ports } = node;
  const name = port(ports, "record_name");
  useEffect(() => {
    let left = false;
    if (name !== "") {
      const query = new URLSearchParams({ model_name: machine, record_name: name, limit: String(KEPT) });
      get("/api/parameters/history", {}, query.toString()).then(
        (found) => left || setChanges(found),
        () => {}, // as of a record that is gone, or one whose name is written while the run goes on
      );
    }
    return () => {
      left = true;
    };
  }, [machine, name]);
  const then = useMemo(() => changes && valuesThen(changes, time), [changes, time]);
  return (
    changes && (
      <div id="record_then">
        <h4>{t("record_then", { name: `${machine}/${name}` })}</h4>
        <p>{then ? listed(then.values, undefined) : t("record_not_then")}</p>
        {then && <p className="small">{`${dateTime(then.newest.stamp)} (${then.newest.source})`}</p>}
      </div>
    )
  );
}
