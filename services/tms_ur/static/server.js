// The server as the console sees it: commands, lists, and the live state with its watchdog.
import { said, t } from "./strings.js";

const SILENCE = 1700; // ms without a state: the server sends one every 0.7 s at least
const LIMIT = 60_000; // ms for an answer
const RETRY = 1000; // ms between attempts to connect
const PROLONG = 60_000; // ms between requests that prolong the session of an open console
const MAX_TREES = 100;
let ahead = 0; // ms by which the site's clock is ahead of this device's

/** The site's time in ms: ages are computed from it, since a tablet's clock may be wrong. */
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
 * Calls onState with every state, and onLink(true or false) when the connection comes and goes; onLink(null) when the
 * page is visible again and the connection is not known yet.
 */
export function watch(onState, onLink) {
  let source = null;
  let connected = null;
  let heard = performance.now();
  let awaited = heard; // begin of the present silence, which does not count while the page is hidden
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

  // Shows the login as soon as the session is over, not only when the operator presses the stop.
  function prolong() {
    prolonged = performance.now();
    ask("/api/session").then(
      (session) => session.name === null && location.reload(),
      () => {}, // the top of the page reports a lost server
    );
  }

  // Without the server the state of the machines is unknown, and the age of their data grows.
  function grow() {
    const age = (machine) => (machine.joint_age === null ? null : machine.joint_age + (performance.now() - heard) / 1000);
    onState({ ...last, machines: last.machines.map((machine) => ({ ...machine, state: "silent", joint_age: age(machine) })) });
  }

  // A browser has six connections to a server for all its pages. A hidden page keeps none of them, so that a stop in
  // another page gets one. When it is visible again, its content is old until the first state comes.
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

/** Why the tree of a run could not be read; null where it is just not written yet. */
export const treeProblem = (runId) => trees.get(runId)?.problem ?? null;

/** The shape of a run's tree; requested once, and again after a second as long as the history has none. */
export function treeOf(runId) {
  const known = trees.get(runId);
  if (known !== undefined && (known.tree !== null || performance.now() - known.asked < 1000)) {
    return known.tree;
  }
  const asked = performance.now();
  trees.set(runId, { tree: null, asked, problem: known?.problem ?? null });
  if (trees.size > MAX_TREES) {
    trees.delete(trees.keys().next().value); // removes the oldest
  }
  ask(`/api/runs/${encodeURIComponent(runId)}/tree`).then(
    (tree) => trees.set(runId, { tree }),
    (problem) => trees.set(runId, { tree: null, asked, problem: problem.reason?.code === "NO_TREE" ? null : problem }),
  );
  return null;
}
