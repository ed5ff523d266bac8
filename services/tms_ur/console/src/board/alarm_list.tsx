// The alarms, with the log of the process that an alarm is about.
import { useTranslation } from "react-i18next";
import type { Alarm } from "./alarms";

export function AlarmList({ alarms }: { alarms: Alarm[] }) {
  const { t } = useTranslation();
  return (
    <ul id="list_alarms" className="rows" aria-label={t("alarms")} hidden={alarms.length === 0}>
      {alarms.map((alarm) => (
        <li key={alarm.key} className="bad">
          <span>▲ {t(alarm.text, alarm.values)}</span>
          <a className="button" href={alarm.text === "process_down" ? `#system/${alarm.key}` : "#system"}>
            {t(alarm.text === "process_down" ? "log" : "p_system")}
          </a>
        </li>
      ))}
    </ul>
  );
}
