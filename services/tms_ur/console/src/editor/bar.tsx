// What can be done with the chosen node, as buttons: all of it has a key, too.
import { useTranslation } from "react-i18next";
import type { Act } from "./keys";

const ACTS: Act[] = ["undo", "redo", "copy", "cut", "paste", "remove", "earlier", "later", "out", "in"];

export function Bar({ cannot, onAct }: { cannot: Act[]; onAct: (act: Act) => void }) {
  const { t } = useTranslation();
  return (
    <div className="bar ed_bar" role="toolbar" aria-label={t("commands")}>
      {ACTS.map((act) => (
        <button key={act} type="button" disabled={cannot.includes(act)} onClick={() => onAct(act)}>
          {t(`ed_${act}`)}
        </button>
      ))}
    </div>
  );
}
