// The map, to click a place on that becomes a record of a machine.

import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { useLive } from "../live";
import { Problem } from "../problem";
import { get } from "../server";
import { useList } from "../use_list";
import { SiteMap } from "./site_map";

const readSite = () => get("/api/site");

interface Props {
  machine: string;
  onSaved: (name: string) => void; // MACHINE/RECORD
  onClose: () => void;
}

export default function PickPlace({ machine, onSaved, onClose }: Props) {
  const { t } = useTranslation();
  const { state } = useLive();
  const { list: site, error } = useList(readSite);
  const bodies = useMemo(() => new Map(site?.machines.map((one) => [one.name, one])), [site]);
  return (
    <section aria-label={t("map")}>
      <p>{t("ed_click_place")}</p>
      <Problem error={error} />
      {state && site && <SiteMap state={state} bodies={bodies} inSpace={false} picking={{ machine, onSaved }} />}
      <button type="button" onClick={onClose}>
        {t("close")}
      </button>
    </section>
  );
}
