// Shared places: who holds them and who waits, and taking one from its holder.
import { button, confirmed, make, part, parts, setBadge, setText } from "./dom.js";
import { fillReason, once } from "./reasons.js";
import { ask } from "./server.js";
import { t } from "./strings.js";

export function buildPlace(place) {
  const name = place.name;
  const take = (event) => once(event.currentTarget, () => revokePlace(name));
  const revoke = button("revoke", "stop", take, ["revoke_place", { name }]);
  revoke.dataset.part = "revoke";
  return make("li", { data: { place: name } }, ...parts("strong", ["name"]), ...parts("span", ["state", "holder"]), revoke,
    ...parts("p", ["queue", "reason"]));
}

export function fillPlace(row, place) {
  setText(part(row, "name"), place.name);
  setBadge(part(row, "state"), `place_${place.state}`);
  setText(part(row, "holder"), place.holder ? t("holds_since", { machine: place.holder, since: clock(place.since) }) : "");
  setText(part(row, "queue"), place.queue.map((one) => t("waits_since", { machine: one.machine, since: clock(one.since) })).join(" "));
  fillReason(part(row, "reason"), place.reason);
  part(row, "revoke").hidden = !place.holder || place.state === "revoked";
}

const clock = (moment) => (moment === null ? "" : new Date(moment).toLocaleTimeString());

async function revokePlace(name) {
  if (!(await confirmed(t("revoke_ask", { name })))) {
    return "";
  }
  const { holder } = await ask(`/api/places/${encodeURIComponent(name)}/revoke`, {});
  return t("place_taken", { name, holder });
}
