// The server as the console sees it: commands, lists, and the live state with its watchdog.
import { said, t } from "./strings.js";

const SILENCE = 1700; // ms without a state: the server sends one every 0.7 s at least
const LIMIT = 60_000; // ms for an answer
const RETRY = 1000; // ms between attempts to connect
const PROLONG = 60_000; // ms; an open console is in use, so its session must not end
const MAX_TREES = 100;
let ahead = 0; // ms by which the site's clock is ahead of this device's

/** The site's time in ms: ages are told by it, since a tablet's clock may be wrong. */
export const siteNow = () => Date.now() + ahead;

/** An answer of the API within `limit` ms; throws an Error whose message people can read, with the reason that the server gave. */
export async function ask(path, body, limit = LIMIT) {
  const signal = AbortSignal.timeout(limit);
  const post = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body), signal };
  let response;
  let answer;
  try {
    response = await fetch(path, body === undefined ? { signal } : post);
    answer = await response.json();
  } catch {
    throw Object.assign(new Error(t("unreachable")), { unreachable: true });
  }
  if (response.status === 401 && path !== "/api/login") {
    location.reload(); // the session is over: the page begins with the login
  }
  if (!response.ok) {
    throw Object.assign(new Error(said(answer)), { reason: answer });
  }
  return answer;
}

/**
 * Calls onState with every state and onLink(true or false) when the connection comes and goes; onLink(null) when the
 * page is looked at again and it is not known yet.
 */
export function watch(onState, onLink) {
  let source = null;
  let connected = null;
  let heard = performance.now();
  let awaited = heard; // since when silence counts: not while nobody listens
  let tried = -RETRY;
  let prolonged = performance.now();
  let last = null;

  function link(now) {
    if (connected !== now) {
      connected = now;
      onLink(now);
    }
  }

  function connect() {
    source?.close();
    tried = performance.now();
    source = new EventSource("/api/events");
    source.addEventListener("state", (event) => {
      heard = performance.now();
      awaited = heard;
      link(true);
      last = JSON.parse(event.data);
      ahead = Date.parse(last.time) - Date.now();
      onState(last);
    });
    source.addEventListener("error", () => link(false));
  }

  // A session that is over shows the login now, and not when somebody presses the stop.
  function prolong() {
    prolonged = performance.now();
    ask("/api/session").then(
      (session) => session.name === null && location.reload(),
      () => {}, // a lost server is told at the top of the page
    );
  }

  // Without the server nobody here knows what a machine does, and the age of its data grows.
  function grow() {
    const age = (machine) => (machine.joint_age === null ? null : machine.joint_age + (performance.now() - heard) / 1000);
    onState({ ...last, machines: last.machines.map((machine) => ({ ...machine, state: "silent", joint_age: age(machine) })) });
  }

  // A browser has six connections to us, whatever the number of its pages. One that nobody looks at keeps none of
  // them, so that a stop in another one finds its own; and what it shows is old until the first state comes again.
  function shown() {
    if (document.hidden) {
      source?.close();
      return;
    }
    awaited = performance.now();
    link(null);
    if (last !== null) {
      grow();
    }
    connect();
  }

  // EventSource retries by itself only after some kinds of loss, and never notices silence.
  function check() {
    const now = performance.now();
    if (now - prolonged > PROLONG) {
      prolong();
    }
    if (document.hidden) {
      return;
    }
    if (now - awaited > SILENCE) {
      link(false);
    }
    if (connected !== true && last !== null) {
      grow();
    }
    if (connected === false && now - tried > RETRY) {
      connect();
      prolong();
    }
  }

  shown();
  document.addEventListener("visibilitychange", shown);
  setInterval(check, 250);
}

const trees = new Map();

/** The shape of a run's tree; asked once, and again a second later as long as the history has none. */
export function treeOf(runId) {
  const known = trees.get(runId);
  if (known !== undefined && (known.tree !== null || performance.now() - known.asked < 1000)) {
    return known.tree;
  }
  trees.set(runId, { tree: null, asked: performance.now() });
  if (trees.size > MAX_TREES) {
    trees.delete(trees.keys().next().value); // the oldest
  }
  ask(`/api/runs/${encodeURIComponent(runId)}/tree`).then(
    (tree) => trees.set(runId, { tree }),
    () => {}, // not written yet, or the database is away: the next state asks again
  );
  return null;
}
