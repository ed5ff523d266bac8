// Shared places: who holds them and who waits, and taking one from its holder.

import { siteNow } from "old/server.js";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { Command } from "../command";
import { confirmed } from "../confirm";
import type { SharedPlace, SharedPlaces } from "../models";
import { Said } from "../said";
import { post } from "../server";
import { said, texts, timeOfDay } from "../texts";

export function Places({ shared }: { shared: SharedPlaces }) {
  const { t } = useTranslation();
  if (shared.places.length === 0) {
    return null;
  }
  return (
    <section id="shared_places">
      <h2>{t("shared_places")}</h2>
      <ul id="place_alarms" className="rows">
        {shared.alarms.map((alarm) => (
          <li key={said(alarm)}>
            <Said reason={alarm} />
          </li>
        ))}
      </ul>
      <ul id="list_places" className="rows">
        {shared.places.map((place) => (
          <Row key={place.name} place={place} />
        ))}
      </ul>
    </section>
  );
}

const clock = (moment: string | null) => (moment === null ? "" : timeOfDay(moment, siteNow()));

async function revoke(name: string): Promise<string> {
  if (!(await confirmed(texts.t("revoke_ask", { name })))) {
    return "";
  }
  const { holder } = await post("/api/places/{name}/revoke", {}, { name });
  return texts.t("place_taken", { name, holder });
}

function Row({ place }: { place: SharedPlace }) {
  const { t } = useTranslation();
  const { name, holder } = place;
  const waits = place.queue.map((one) => t("waits_since", { machine: one.machine, since: clock(one.since) }));
  return (
    <li data-place={name}>
      <strong>{name}</strong>
      <Badge state={`place_${place.state}`} />
      <span data-part="holder">{holder && t("holds_since", { machine: holder, since: clock(place.since) })}</span>
      {holder && place.state !== "revoked" && (
        <Command className="stop" label={t("revoke_place", { name })} work={() => revoke(name)}>
          {t("revoke")}
        </Command>
      )}
      <p>{waits.join(" ")}</p>
      <p>
        <Said reason={place.reason} />
      </p>
    </li>
  );
}
