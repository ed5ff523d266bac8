// What stands above every page: the site, its time, who is logged in, the language, and the software stop.

import { siteNow } from "old/server.js";
import { stop } from "old/stop.js";
import { switchLanguage } from "old/strings.js";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Session } from "./models";
import { get, post } from "./server";
import { texts, timeOfDay } from "./texts";

const TICK = 1000; // ms

export function Header({ session, inside }: { session: Session | null; inside: boolean }) {
  const { t } = useTranslation();
  return (
    <header>
      <h1>
        {t("title")} <small>ROS2-TMS</small>
      </h1>
      {inside && <Where />}
      <span id="who">{inside && session ? whoIs(session) : ""}</span>
      <button type="button" id="logout" hidden={!inside || !session?.login} onClick={leave}>
        {t("logout")}
      </button>
      <button type="button" id="language" onClick={switchLanguage}>
        {t("language")}
      </button>
      <button type="button" id="stop" className="stop" hidden={session !== null && !inside} onClick={() => stop()}>
        {t("stop")}
      </button>
    </header>
  );
}

/** The name of the site, and the time there: a tablet's own clock may be wrong. */
function Where() {
  const [site, setSite] = useState("");
  const [now, setNow] = useState(siteNow());
  useEffect(() => {
    get("/api/site").then(
      (found) => setSite(found.name),
      () => {}, // the name is no reason for an alarm: the connection has its own
    );
    const timer = setInterval(() => setNow(siteNow()), TICK);
    return () => clearInterval(timer);
  }, []);
  return (
    <span id="where">
      <strong>{site}</strong> <time>{timeOfDay(new Date(now).toISOString(), now)}</time>
    </span>
  );
}

/** Without users, whoever is at this PC may do all; others may look where they can connect at all. */
function whoIs({ login, name, role }: Session): string {
  if (login) {
    return `${name} (${texts.t(role ?? "")})`;
  }
  return texts.t(role === "admin" ? "no_login" : "no_login_view");
}

async function leave() {
  await post("/api/logout", {});
  location.reload();
}
