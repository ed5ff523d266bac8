// System: what is wrong, processes of every PC, logs, and the audit of commands.
import { useTranslation } from "react-i18next";
import { AlarmList } from "../board/alarm_list";
import { useLive } from "../live";
import { Audit } from "./audit";
import { addressOf, type Chosen, chosenOf } from "./chosen";
import { LogChooser } from "./log_chooser";
import { MergedLog } from "./merged_log";
import { Processes } from "./processes";

const open = (chosen: Chosen) => {
  location.hash = addressOf(chosen);
};
const openProcess = (name: string) => open({ kind: "process", name });

/** `rest`: whose log is shown; that of a process stands below its row. */
export default function SystemPage({ rest }: { rest: string }) {
  const { t } = useTranslation();
  const { state } = useLive();
  const alarms = state?.alarms ?? [];
  const chosen = chosenOf(rest);
  const { kind, name } = chosen;
  return (
    <>
      <h2>{t("alarms")}</h2>
      {state !== null && alarms.length === 0 && <p id="no_alarms">{t("no_alarms")}</p>}
      <AlarmList alarms={alarms} />
      {state !== null && <Processes state={state} open={kind === "process" ? name : ""} onOpen={openProcess} />}
      <h2>{t("logs")}</h2>
      {state !== null && <LogChooser state={state} chosen={chosen} onChosen={open} />}
      {kind !== "process" && name !== "" && <MergedLog key={rest} of={kind} name={name} />}
      <Audit />
    </>
  );
}
