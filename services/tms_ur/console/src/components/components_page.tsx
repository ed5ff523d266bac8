// For developers: colours, type, and every component in its states, in both languages and both schemes.
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { MachineCard } from "../board/machine_card";
import { Command } from "../command";
import { confirmed } from "../confirm";
import { Downloads } from "../downloads";
import { Problem } from "../problem";
import { Said } from "../said";
import { Table } from "../table";
import { TreeFlow } from "../tree/flow";
import { DIGITS, MACHINES, reason, TREE } from "./samples";
import "./components.css";

const FILLS = ["good-fill", "bad-fill", "calm-fill", "moving-fill", "head"];
const LETTERS = ["ink", "good", "bad", "calm", "warn", "goal"];
const STATES = ["moving", "standing", "not_ready", "silent", "armed", "held", "latched", "by_hand"];
const PROCESSES = ["RUNNING", "STARTING", "STOPPING", "on_demand", "down", "FATAL", "BACKOFF", "UNKNOWN"];
const RUNS = ["preparing", "running", "stopping", "success", "failure", "interrupted", "abandoned"];
const NONE = new Map();

export default function ComponentsPage() {
  const { t } = useTranslation();
  return (
    <>
      <h2>{t("components")}</h2>
      <Tokens />
      {[STATES, PROCESSES, RUNS].map((states) => (
        <p key={states[0]} className="shown_states">
          {states.map((state) => (
            <Badge key={state} state={state} />
          ))}
        </p>
      ))}
      <Buttons />
      <Reasons />
      <div className="cards">
        {MACHINES.map((machine) => (
          <MachineCard key={machine.name} machine={machine} run={undefined} />
        ))}
      </div>
      <TreeFlow tree={TREE} digits={DIGITS} leaf="0.1" last={NONE} facts={() => null} />
      <Table id="list_components" label="components" heads={["machine", "state"]}>
        <tr>
          <td>zx200</td>
          <td>{t("none_processes")}</td>
        </tr>
      </Table>
    </>
  );
}

/** Colours as they are used: a fill below its letters, letters on the page. */
function Tokens() {
  return (
    <div className="bar" id="tokens">
      {FILLS.map((name) => (
        <span key={name} className={`token fill ${name}`}>
          {name}
        </span>
      ))}
      {LETTERS.map((name) => (
        <span key={name} className={`token ${name}`}>
          {name}
        </span>
      ))}
    </div>
  );
}

function Buttons() {
  const { t } = useTranslation();
  const ask = async () => ((await confirmed(t("confirm"))) ? t("confirm") : "");
  return (
    <>
      <div className="bar">
        <Command work={ask}>{t("restart")}</Command>
        <Command work={ask} className="go">
          {t("rearm")}
        </Command>
        <Command work={ask} className="stop">
          {t("stop_one")}
        </Command>
        <Command work={ask} disabled>
          {t("restart")}
        </Command>
        <a className="button" href="#components">
          {t("today")}
        </a>
        <a className="button" href="#components" aria-current="true">
          {t("today")}
        </a>
      </div>
      <Downloads id="sample_files" label="export" files={[["CSV", "#components"]]} />
    </>
  );
}

/** What helps is a button where the console can do it, a link where a page shows it, else words. */
function Reasons() {
  const error = Object.assign(new Error("zx200:rc"), { reason: reason("status", {}) });
  return (
    <div id="sample_reasons">
      <p>
        <Said reason={reason("rearm", { machine: "zx200" })} />
      </p>
      <p>
        <Said reason={reason("edit_task", {})} />
      </p>
      <p>
        <Said reason={reason("nothing", {})} />
      </p>
      <Problem id="sample_problem" error={error} />
    </div>
  );
}
