// Tells on every page how a run has ended.
import { duration, say } from "old/dom.js";
import { ended, subscribe } from "./live";
import type { ActiveRun, Run } from "./models";
import { get } from "./server";
import { said, texts } from "./texts";

const LOOKS = 20; // tries for the end of a run, which may leave the list of runs before the history has its end
const LOOK = 250; // ms between tries

export function tellEnds() {
  subscribe((now, before) => {
    for (const run of now.state === before.state ? [] : ended(now.state, before.state)) {
      tell(run);
    }
  });
}

async function tell({ run_id }: ActiveRun) {
  let run: Run | undefined;
  for (let i = 0; i < LOOKS && !run?.ended_at; i += 1) {
    if (i > 0) {
      await new Promise((done) => setTimeout(done, LOOK));
    }
    const found = await get("/api/runs", {}, "limit=50").catch(() => []);
    run = found.find((one) => one.run_id === run_id);
  }
  if (run?.started_at && run.ended_at && run.state !== "refused") {
    // who started it has got the reason
    const seconds = (Date.parse(run.ended_at) - Date.parse(run.started_at)) / 1000;
    const facts = {
      task: run.task_id,
      state: texts.t(run.state),
      duration: duration(seconds),
      reason: said(run.reason),
    };
    say(texts.t("run_ended", facts), run.state !== "success");
    const link = Object.assign(document.createElement("a"), {
      className: "button",
      href: `#history/${encodeURIComponent(run_id)}`,
      textContent: texts.t("p_history"),
    });
    document.getElementById("message")?.append(" ", link);
  }
}
