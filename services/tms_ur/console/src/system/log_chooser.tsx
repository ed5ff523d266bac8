// Whose log is shown: that of a process, or those of all processes of a machine or a run. The address names it.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Run, State } from "../models";
import { get } from "../server";
import { dateTime } from "../texts";
import { useList } from "../use_list";
import { type Chosen, KINDS, type Kind } from "./chosen";

const readRuns = () => get("/api/runs", {}, "limit=50");

interface Props {
  state: State;
  chosen: Chosen;
  onChosen: (chosen: Chosen) => void;
}

export function LogChooser({ state, chosen, onChosen }: Props) {
  const { t } = useTranslation();
  const runs = useList(readRuns).list ?? [];
  const [picked, setPicked] = useState<Kind | null>(null); // null: that of the address
  const kind = picked ?? (chosen.name === "" ? "machine" : chosen.kind);
  const names = namesOf(kind, state, runs);
  const name = kind === chosen.kind ? chosen.name : "";
  if (name !== "" && !names.has(name)) {
    names.set(name, name);
  }
  const choose = (one: string) => {
    setPicked(null);
    onChosen({ kind, name: one });
  };
  return (
    <div className="bar">
      <label>
        {t("log_of_kind")}
        <select id="log_kind" value={kind} onChange={(event) => setPicked(event.target.value as Kind)}>
          {KINDS.map((one) => (
            <option key={one} value={one}>
              {t(one)}
            </option>
          ))}
        </select>
      </label>
      <label>
        {t(kind)}
        <select id="log_name" value={name} onChange={(event) => choose(event.target.value)}>
          <option value="">{t("choose_log")}</option>
          {[...names].map(([one, shown]) => (
            <option key={one} value={one}>
              {shown}
            </option>
          ))}
        </select>
      </label>
    </div>
  );
}

/** What there is of a kind, and how each is shown. */
function namesOf(kind: Kind, state: State, runs: Run[]): Map<string, string> {
  if (kind === "run") {
    return new Map(runs.map((run) => [run.run_id, `${run.task_id} ${run.description} ${dateTime(run.started_at)}`]));
  }
  const named = kind === "machine" ? state.machines : state.hosts.flatMap((host) => host.processes);
  return new Map(named.map(({ name }) => [name, name]));
}
