// What merged logs do not hold.
import { useTranslation } from "react-i18next";
import type { Logs } from "./models";
import { Said } from "./said";

export function LogNotes({ logs }: { logs: Logs }) {
  const { t } = useTranslation();
  return (
    <ul className="plain log_notes">
      {logs.missing.map(({ process, reason }) => (
        <li key={process}>
          <span>▲ {t("log_missing", { process })}</span> <Said reason={reason} />
        </li>
      ))}
      {logs.short.length > 0 && <li>▲ {t("log_short", { names: logs.short.join(", ") })}</li>}
      {logs.cut && <li>▲ {t("log_cut")}</li>}
      {logs.lines.length === 0 && <li>{t("none_log")}</li>}
    </ul>
  );
}
