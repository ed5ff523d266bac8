// The console's frame: login, pages, connection, questions, and the software stop, which is on every page.
import { at, duration, keep, make, relabelAll, say, setText } from "./dom.js";
import { buildQuestion, fillQuestion } from "./questions.js";
import { sayError } from "./reasons.js";
import { ask, watch } from "./server.js";
import { reportOpen, stop } from "./stop.js";
import { onLanguage, said, switchLanguage, t, translatePage } from "./strings.js";
import { PAGE_NAMES } from "./words.js";

// Each page has build(root), update(state), and load() where it needs lists
const load = async (name) => [name, await import(`./pages/${name}.js`)];
const PAGES = Object.fromEntries(await Promise.all(PAGE_NAMES.map(load)));
let shown = null; // name of the page on the screen
let state = null;

function open() {
  const [name, ...rest] = location.hash.slice(1).split("/");
  const next = name in PAGES ? name : "run";
  if (next !== shown) {
    shown = next;
    at("page").replaceChildren();
    at("page").dataset.page = next;
    PAGES[next].build(at("page"));
    say(""); // the message belongs to another page
    translatePage();
  }
  for (const link of at("pages").children) {
    link.ariaCurrent = link.hash === `#${next}` ? "page" : "false";
  }
  PAGES[next].open?.(rest.map(decodeURIComponent));
  PAGES[next].load?.();
  if (state !== null) {
    PAGES[next].update(state);
  }
}

function heard(now) {
  const ids = (one) => one?.runs.map((each) => `${each.run_id} ${each.state}`).join();
  const changed = state !== null && ids(state) !== ids(now);
  const ended = state === null ? [] : state.runs.filter((one) => !now.runs.some((other) => other.run_id === one.run_id));
  state = now;
  ended.forEach((run) => tellEnd(run.run_id));
  keep(at("questions"), now.questions, (one) => one.id, buildQuestion, fillQuestion);
  PAGES[shown].update(now);
  if (changed) {
    PAGES[shown].load?.();
  }
}

const LOOKS = 20; // tries for the end of a run, which may leave the list of runs before the history has its end
const LOOK = 250; // ms between tries

/** Shows how a run has ended, on any page. */
async function tellEnd(id) {
  let run;
  for (let i = 0; i < LOOKS && !run?.ended_at; i += 1) {
    if (i > 0) {
      await new Promise((done) => { setTimeout(done, LOOK); });
    }
    run = (await ask("/api/runs?limit=50").catch(() => [])).find((one) => one.run_id === id);
  }
  if (run?.ended_at && run.state !== "refused") { // the operator who started it has got the reason
    const seconds = (new Date(run.ended_at) - new Date(run.started_at)) / 1000;
    say(t("run_ended", { task: run.task_id, state: t(run.state), duration: duration(seconds), reason: said(run.reason) }), run.state !== "success");
    at("message").append(" ", make("a", { className: "button", href: `#history/${encodeURIComponent(id)}` }, t("p_history")));
  }
}

function linked(there) {
  at("connecting").hidden = there !== null;
  at("lost").hidden = there !== false;
  document.body.classList.toggle("old", !there);
  if (there) {
    PAGES[shown].load?.();
  }
}

// life

async function enter() {
  const session = await ask("/api/session");
  at("login").hidden = session.name !== null;
  reportOpen(session);
  if (session.name === null) {
    at("connecting").hidden = true;
    at("stop").hidden = true;
    at("login_name").focus();
    return;
  }
  at("stop").hidden = false;
  at("logout").hidden = !session.login;
  const who = () => setText(at("who"), session.login ? `${session.name} (${t(session.role)})` : "");
  who();
  onLanguage(who);
  document.body.dataset.role = session.role;
  for (const name of Object.keys(PAGES)) {
    at("pages").append(make("a", { href: `#${name}`, data: { t: `p_${name}` } }));
  }
  translatePage();
  open();
  addEventListener("hashchange", open);
  watch(heard, linked);
}

at("login").addEventListener("submit", async (event) => {
  event.preventDefault();
  try {
    await ask("/api/login", { name: at("login_name").value, password: at("login_password").value });
    const panel = Number(new URLSearchParams(location.search).get("panel")); // a panel sent the browser here
    if (panel) {
      location.href = `/panel.html?task=${panel}`;
    } else {
      location.reload();
    }
  } catch (error) {
    at("login_password").value = "";
    sayError(error);
  }
});
at("logout").addEventListener("click", () => ask("/api/logout", {}).then(() => location.reload()));
at("language").addEventListener("click", switchLanguage);
at("stop").addEventListener("click", () => stop());
// The dialog has a stop button of its own, since it covers the button of the page.
at("dialog").addEventListener("close", () => at("dialog").returnValue === "stop" && stop());
at("skip").addEventListener("click", (event) => {
  event.preventDefault(); // the hash holds the page's name
  at("main").focus();
});
onLanguage(() => {
  relabelAll();
  if (state !== null) {
    PAGES[shown].redraw?.();
    heard(state);
    PAGES[shown].load?.();
  }
});
translatePage();

async function begin() {
  try {
    await enter();
  } catch {
    at("connecting").hidden = true;
    at("lost").hidden = false;
    setTimeout(begin, 1000);
  }
}

begin();
