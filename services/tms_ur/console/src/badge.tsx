// A state in words, by a shape and a colour.

import { mark, tone } from "old/dom.js";
import { useTranslation } from "react-i18next";

export function Badge({ state }: { state: string }) {
  const { t } = useTranslation();
  return (
    <span className={`badge ${tone(state)}`}>
      {mark(state)} {t(state)}
    </span>
  );
}
