// The values that a record has had: as a plot, and as a table.
import { lazy, Suspense, useEffect, useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import type { RecordChange, Stored } from "../models";
import { Table } from "../table";
import { dateTime } from "../texts";
import { linesOf } from "./series";
import { listed, nameOf } from "./values";

const Plot = lazy(() => import("../plot"));

interface Props {
  record: Stored;
  changes: RecordChange[]; // newest first
  onClose: () => void;
}

export function RecordHistory({ record, changes, onClose }: Props) {
  const { t } = useTranslation();
  const section = useRef<HTMLElement>(null);
  const { times, lines } = useMemo(() => linesOf(changes), [changes]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the history of another record is shown
  useEffect(() => void section.current?.scrollIntoView(), [changes]);
  const title = t("values_of", { name: nameOf(record) });
  return (
    <section id="values" ref={section}>
      <h2 id="values_title">{title}</h2>
      <button type="button" onClick={onClose}>
        {t("close")}
      </button>
      {changes.length === 0 && <p id="none_values">{t("none_values")}</p>}
      {lines.length > 0 && (
        <Suspense>
          <Plot label={title} times={times} lines={lines} />
        </Suspense>
      )}
      <Table id="list_values" label="record_history" heads={["at_time", "source", "values"]}>
        {changes.map((change, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: changes have no other name
          <tr key={index}>
            <td>{dateTime(change.stamp)}</td>
            <td>{change.source}</td>
            <td className="values">{listed(change.values, record)}</td>
          </tr>
        ))}
      </Table>
    </section>
  );
}
