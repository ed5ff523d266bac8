// How long ago something was, by the clock of the site; it grows while one looks.
import { duration } from "old/dom.js";
import { siteNow } from "old/server.js";
import { useTranslation } from "react-i18next";
import { useLive } from "./live";

export function Age({ stamp }: { stamp: string | null | undefined }) {
  const { t } = useTranslation();
  useLive(); // each state draws it anew
  return <>{stamp ? duration(Math.max(0, (siteNow() - Date.parse(stamp)) / 1000)) : t("never")}</>;
}
