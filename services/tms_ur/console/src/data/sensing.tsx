// The sensing inputs: what comes, how often, and what was refused.
import { duration } from "old/dom.js";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import type { SensingInput } from "../models";
import { Said } from "../said";
import { get } from "../server";
import { Table } from "../table";

const EVERY = 2000; // ms

function useInputs(): SensingInput[] | null {
  const [inputs, setInputs] = useState<SensingInput[] | null>(null);
  useEffect(() => {
    const look = () =>
      get("/api/sensing").then(
        (found) => setInputs(found.inputs),
        () => {}, // the connection has an alarm of its own
      );
    look();
    const timer = setInterval(look, EVERY);
    return () => clearInterval(timer);
  }, []);
  return inputs;
}

export function Sensing() {
  const { t } = useTranslation();
  const inputs = useInputs();
  return (
    <>
      <h2>{t("sensing")}</h2>
      {inputs?.length === 0 && <p id="none_sensing">{t("none_sensing")}</p>}
      <Table
        id="list_sensing"
        label="sensing"
        heads={["input", "state", "topic", "hz", "age", "accepted", "refusals", "last_refusal", "record"]}
      >
        {inputs?.map((one) => (
          <Row key={one.name} one={one} />
        ))}
      </Table>
    </>
  );
}

function Row({ one }: { one: SensingInput }) {
  const rate = one.hz.toFixed(1) + (one.hz_expected === null ? "" : ` / ${one.hz_expected}`);
  return (
    <tr>
      <td>{one.name}</td>
      <td>
        <Badge state={one.state === "silent" ? "no_messages" : one.state} />
      </td>
      <td>{one.topic}</td>
      <td>{rate} Hz</td>
      <td>{one.age === null ? "-" : duration(one.age)}</td>
      <td>{one.accepted}</td>
      <td>{one.refused}</td>
      <td>
        <Said reason={one.last_refusal} />
      </td>
      <td>{one.records.join(", ")}</td>
    </tr>
  );
}
