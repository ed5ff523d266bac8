// The sensing inputs: what comes, how often, and what was refused.
import { duration } from "old/dom.js";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import type { SensingInput } from "../models";
import { Problem } from "../problem";
import { repeated } from "../repeated";
import { Said } from "../said";
import { get } from "../server";
import { Table } from "../table";

const EVERY = 2000; // ms

function useInputs() {
  const [inputs, setInputs] = useState<SensingInput[] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    const took = (found: { inputs: SensingInput[] }) => {
      setInputs(found.inputs);
      setError(null);
    };
    return repeated(() => get("/api/sensing"), took, setError, EVERY);
  }, []);
  return { inputs, error };
}

export function Sensing() {
  const { t } = useTranslation();
  const { inputs, error } = useInputs();
  return (
    <>
      <h2>{t("sensing")}</h2>
      <Problem id="sensing_problem" error={error} />
      {inputs?.length === 0 && <p id="none_sensing">{t("none_sensing")}</p>}
      <Table
        id="list_sensing"
        label="sensing"
        heads={["input", "state", "topic", "hz", "age", "accepted", "refusals", "last_refusal", "record"]}
        blocks
      >
        {inputs?.map((one) => (
          <Row key={one.name} one={one} />
        ))}
      </Table>
    </>
  );
}

function Row({ one }: { one: SensingInput }) {
  const { t } = useTranslation();
  const rate = one.hz.toFixed(1) + (one.hz_expected === null ? "" : ` / ${one.hz_expected}`);
  return (
    <tr>
      <td>{one.name}</td>
      <td>
        <Badge state={one.state === "silent" ? "no_messages" : one.state} />
      </td>
      <td className="wide">{one.topic}</td>
      <td data-label={t("hz")}>{rate} Hz</td>
      <td data-label={t("age")}>{one.age === null ? "-" : duration(one.age)}</td>
      <td data-label={t("accepted")}>{one.accepted}</td>
      <td data-label={t("refusals")}>{one.refused}</td>
      <td className="wide">
        <Said reason={one.last_refusal} />
      </td>
      <td data-label={t("record")}>{one.records.join(", ")}</td>
    </tr>
  );
}
