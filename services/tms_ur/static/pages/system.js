// System: processes of every PC, their logs, restart; and the audit of commands.
import { at, button, duration, heading, keep, make, part, parts, setBadge, setText, table } from "../dom.js";
import { restartProcess } from "../actions.js";
import { once } from "../reasons.js";
import { ask } from "../server.js";
import { t, when } from "../strings.js";

let running = 0; // number of active runs

export function build(root) {
  root.append(
    heading("processes"), make("p", { id: "none_processes", hidden: true, data: { t: "none_processes" } }),
    table("list_processes", "processes", ["process", "host", "state", "uptime", "cpu", "memory", "restarts", "log"]),
    make("section", { id: "log", hidden: true }, make("h2", { id: "log_title" }), button("close", "", () => { at("log").hidden = true; }),
      make("pre", { id: "log_text", tabIndex: 0 })),
    heading("audit"), make("p", { id: "none_audit", hidden: true, data: { t: "none_audit" } }),
    table("list_audit", "audit", ["at_time", "who", "what", "target"]),
  );
}

export async function load() {
  let audit;
  try {
    audit = (await ask("/api/audit")).reverse();
  } catch {
    return; // the database is away; the processes are shown nevertheless
  }
  if (at("list_audit") === null) {
    return;
  }
  at("none_audit").hidden = audit.length > 0;
  keep(at("list_audit"), audit, (event) => event.number, () => make("tr", {}, ...parts("td", ["time", "who", "what", "target"])), (row, event) => {
    setText(part(row, "time"), when(event.stamp));
    setText(part(row, "who"), event.text);
    const times = event.values.times > 1 ? ` ×${event.values.times}` : ""; // refusals of a minute are one entry
    setText(part(row, "what"), t(`did_${event.kind}`) + times);
    setText(part(row, "target"), event.node);
  });
}

export function update(state) {
  running = state.runs.length;
  const rows = state.hosts.flatMap((host) => host.processes.map((process) => ({ host: host.name, process })));
  at("none_processes").hidden = rows.length > 0;
  keep(at("list_processes"), rows, ({ host, process }) => `${host}/${process.name}`, buildProcess, fillProcess);
}

function buildProcess({ process }) {
  const name = process.name;
  const restart = (event) => once(event.currentTarget, () => restartProcess(name, running));
  return make("tr", {}, ...parts("td", ["name", "host"]), make("td", {}, ...parts("span", ["state"])), ...parts("td", ["uptime", "cpu", "memory", "restarts"]),
    make("td", { className: "bar" }, button("log", "", (event) => once(event.currentTarget, () => showLog(name)), ["log_of", { name }]),
      button("restart", "", restart, ["restart_process", { name }])));
}

function fillProcess(row, { host, process }) {
  setText(part(row, "name"), process.name);
  setText(part(row, "host"), host);
  setBadge(part(row, "state"), process.state);
  setText(part(row, "uptime"), process.state === "RUNNING" ? duration(process.uptime) : "-");
  setText(part(row, "cpu"), process.pid ? `${process.cpu.toFixed(1)} %` : "-");
  setText(part(row, "memory"), process.pid ? `${Math.round(process.memory / 1e6)} MB` : "-");
  setText(part(row, "restarts"), String(process.restarts));
}

async function showLog(name) {
  const { text } = await ask(`/api/processes/${encodeURIComponent(name)}/log`);
  setText(at("log_title"), t("log_of", { name }));
  setText(at("log_text"), text);
  at("log").hidden = false;
  at("log_text").scrollTop = at("log_text").scrollHeight;
  at("log").scrollIntoView();
}
