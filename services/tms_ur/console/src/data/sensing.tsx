// The sensing inputs: what comes, how often, and what was refused.
import { duration } from "old/dom.js";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import type { SensingInput } from "../models";
import { Problem } from "../problem";
import { Said } from "../said";
import { get } from "../server";
import { Table } from "../table";
import { useRepeated } from "../use_repeated";

const EVERY = 2000; // ms

const ask = () => get("/api/sensing");

export function Sensing() {
  const { t } = useTranslation();
  const { found, error } = useRepeated(ask, EVERY);
  const inputs = found?.inputs;
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
