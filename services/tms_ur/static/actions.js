// The console's remedies for reasons, by the name of the reason's action.
import { confirmed } from "./dom.js";
import { ask } from "./server.js";
import { said, t } from "./strings.js";

/** Commands by action, from its arguments; each resolves to the text to show. */
export const COMMANDS = {
  rearm: ({ machine }) => rearmMachine(machine),
  escape: ({ machine }) => letBack(machine),
  cancel: ({ run }) => cancelRun(run),
  restart: ({ process }) => restartProcess(process),
  give_back: ({ machine }) => giveBack(machine),
};

const page = (name) => () => name;
const processPage = ({ process }) => (process ? `system/${encodeURIComponent(process)}` : "system"); // with its log

/** Pages by action, from its arguments, where a person sees or corrects the cause. */
export const LINKS = {
  processes: processPage, restart: processPage, logs: processPage, status: page("system"),
  tasks: page("tasks"), templates: page("tasks"), edit_task: page("tasks"),
  records: page("data"), goal: page("data"), move: page("data"),
  enable_areas: page("map"), draw: page("map"), check_areas: page("map"),
  places: page("board"), revoke: page("board"), resume: page("board"), runs: page("history"),
};

export async function rearmMachine(name) {
  const path = `/api/machines/${encodeURIComponent(name)}/rearm`;
  const first = await ask(path, {});
  if (!(await confirmed(t("rearm_ask", { name, cause: said(first.cause) })))) {
    return "";
  }
  await ask(path, { token: first.token });
  return t("rearmed", { name });
}

/** Re-arms a machine that stands outside its areas, if it is stopped, and lets it be moved back in. */
export async function letBack(name) {
  const path = `/api/machines/${encodeURIComponent(name)}`;
  if (!(await confirmed(t("escape_ask", { name })))) {
    return "";
  }
  const first = await ask(`${path}/rearm`, {}).catch((error) => {
    if (error.reason?.code !== "NOT_STOPPED") {
      throw error;
    }
    return null;
  });
  if (first !== null) {
    await ask(`${path}/rearm`, { token: first.token });
  }
  await ask(`${path}/escape`, {});
  return t("escapes", { name });
}

/** Ends driving by hand; the text tells whether the machine was seen to stand. */
export async function giveBack(name) {
  if (!(await confirmed(t("give_back_ask", { name })))) {
    return "";
  }
  const receipt = await ask(`/api/machines/${encodeURIComponent(name)}/give-back`, {});
  const seen = t(receipt.confirmed ? "stood" : "not_stood", { ...receipt, detail: said(receipt.detail) });
  if (!receipt.confirmed) {
    throw new Error(seen);
  }
  return `${t("given_back", { name })} ${seen}`;
}

export async function cancelRun(id) {
  await ask(`/api/runs/${encodeURIComponent(id)}/cancel`, {});
  return t("cancelling", { id });
}

export async function restartProcess(name, running = 0) {
  const question = t("restart_ask", { name }) + (running > 0 ? ` ${t("restart_running", { running })}` : "");
  if (!(await confirmed(question))) {
    return "";
  }
  await ask(`/api/processes/${encodeURIComponent(name)}/restart`, {});
  return t("restarted", { name });
}
