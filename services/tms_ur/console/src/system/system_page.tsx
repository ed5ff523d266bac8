// System: what is wrong, processes of every PC with their logs, and the audit of commands.
import { useTranslation } from "react-i18next";
import { AlarmList } from "../board/alarm_list";
import { useLive } from "../live";
import { Audit } from "./audit";
import { Processes } from "./processes";

const open = (process: string) => {
  location.hash = process === "" ? "#system" : `#system/${process}`;
};

/** `rest`: the process whose log is shown. */
export default function SystemPage({ rest }: { rest: string }) {
  const { t } = useTranslation();
  const { state } = useLive();
  const alarms = state?.alarms ?? [];
  return (
    <>
      <h2>{t("alarms")}</h2>
      {state !== null && alarms.length === 0 && <p id="no_alarms">{t("no_alarms")}</p>}
      <AlarmList alarms={alarms} />
      {state !== null && <Processes state={state} open={decodeURIComponent(rest)} onOpen={open} />}
      <Audit />
    </>
  );
}
