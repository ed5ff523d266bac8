// The frame of every page: who is logged in, the connection, questions, the pages, and the software stop.

import { reportOpen } from "old/stop.js";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Confirm } from "./confirm";
import { Header } from "./header";
import { connect, useLive } from "./live";
import { Login } from "./login";
import type { Session } from "./models";
import { Pages } from "./pages";
import { Questions } from "./questions";
import { tellEnds } from "./run_ends";
import { get } from "./server";

const RETRY = 1000; // ms between attempts to reach the server at the start

/** Who is logged in; null until the server has told, and "lost" while it cannot be reached. */
function useSession(): Session | "lost" | null {
  const [session, setSession] = useState<Session | "lost" | null>(null);
  useEffect(() => {
    let timer = 0;
    const enter = async () => {
      try {
        const found = await get("/api/session");
        document.body.dataset.role = found.role ?? ""; // before anything is drawn for this person
        setSession(found);
        reportOpen(found);
        if (found.name !== null) {
          connect();
          tellEnds();
        }
      } catch {
        setSession("lost");
        timer = window.setTimeout(enter, RETRY);
      }
    };
    enter();
    return () => clearTimeout(timer);
  }, []);
  return session;
}

export function App() {
  const { t } = useTranslation();
  const session = useSession();
  const { link } = useLive();
  const person = session === "lost" ? null : session;
  const inside = person !== null && person.name !== null;
  const lost = session === "lost" || (inside && link === false);
  document.body.classList.toggle("old", inside && !link);
  return (
    <>
      {/* biome-ignore lint/a11y/useValidAnchor: it goes to a place of the page, but the address holds the page's name */}
      <a className="skip" href="#main" id="skip" onClick={toMain}>
        {t("skip")}
      </a>
      <Header session={person} inside={inside} />
      <div id="notes">
        <p
          id="connecting"
          className="banner"
          role="status"
          hidden={lost || link === true || (person !== null && !inside)}
        >
          {t("connecting")}
        </p>
        <p id="lost" className="banner bad" role="alert" hidden={!lost}>
          {t("lost")}
        </p>
        {/* written by stop.js and dom.js */}
        <p id="stop_report" role="alert" />
        <p id="message" role="status" />
      </div>
      {inside && <Questions />}
      {person !== null && !inside && (
        <main id="main" tabIndex={-1}>
          <Login />
        </main>
      )}
      {inside && <Pages />}
      <Confirm />
    </>
  );
}

function toMain(event: React.MouseEvent) {
  event.preventDefault(); // the address holds the page's name
  document.getElementById("main")?.focus();
}
