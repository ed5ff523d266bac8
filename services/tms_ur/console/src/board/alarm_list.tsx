// The alarms as the server judges them: how urgent by shape, word and colour, since when, and what helps.
import { siteNow } from "old/server.js";
import { useTranslation } from "react-i18next";
import type { Alarm } from "../models";
import { Said } from "../said";
import { timeOfDay } from "../texts";

const MARKS = { critical: "⬣", warning: "▲" };

export function AlarmList({ alarms }: { alarms: Alarm[] }) {
  const { t } = useTranslation();
  return (
    <ul id="list_alarms" className="rows" aria-label={t("alarms")} hidden={alarms.length === 0}>
      {alarms.map((alarm) => (
        <li key={`${alarm.name}/${alarm.subject}`} className={`alarm ${alarm.severity}`} title={alarm.name}>
          <strong>{`${MARKS[alarm.severity]} ${t(`alarm_${alarm.severity}`)}`}</strong> <Said reason={alarm.reason} />{" "}
          <span className="small">{t("since", { time: timeOfDay(alarm.since, siteNow()) })}</span>
        </li>
      ))}
    </ul>
  );
}
