// The first page: one light for the site, what needs a person, its machines, its runs, and tasks to start.
import "./board.css";
import { useTranslation } from "react-i18next";
import { useLive } from "../live";
import type { ActiveRun, State } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { useList } from "../use_list";
import { ActiveRuns } from "./active_runs";
import { AlarmList } from "./alarm_list";
import { Interrupted } from "./interrupted";
import { lightOf, markOf } from "./light";
import { MachineCard } from "./machine_card";
import { Places } from "./places";
import { Tasks } from "./tasks";

const LATEST = 200; // runs of the history among which interrupted ones are looked for
const readInterrupted = async () =>
  (await get("/api/runs", {}, `limit=${LATEST}`)).filter((run) => run.state === "interrupted");

export function Board() {
  const { t } = useTranslation();
  const { state, link } = useLive();
  const interrupted = useList(readInterrupted);
  if (state === null) {
    return <Tasks />;
  }
  const { alarms = [] } = state;
  const runs = interrupted.list ?? [];
  const open = runs.length + (interrupted.error === null ? 0 : 1); // what is not known needs a look, too
  return (
    <div className="board">
      <SiteLight state={state} link={link} needed={alarms.length + open + state.shared.alarms.length} />
      <AlarmList alarms={alarms} />
      <Problem id="interrupted_problem" what={t("interrupted_unknown")} error={interrupted.error} />
      <Interrupted runs={runs} changed={interrupted.again} />
      <div className="halves">
        <div>
          <ActiveRuns runs={state.runs} />
          <Tasks />
        </div>
        <div>
          <Machines state={state} />
          <Places shared={state.shared} />
        </div>
      </div>
    </div>
  );
}

function SiteLight({ state, link, needed }: { state: State; link: boolean | null; needed: number }) {
  const { t } = useTranslation();
  const { light, machines } = lightOf(state, link, needed);
  return (
    <p id="light" className={`light ${light}`} role="status">
      <span aria-hidden="true">{markOf(light)}</span> <strong>{t(`light_${light}`)}</strong>{" "}
      <span>{machines.join(", ")}</span>
    </p>
  );
}

function Machines({ state }: { state: State }) {
  const { t } = useTranslation();
  const having = (name: string): ActiveRun | undefined => state.runs.find((run) => run.machines.includes(name));
  return (
    <section>
      <h2>{t("machines")}</h2>
      {state.machines.length === 0 && <p id="none_machines">{t("none_machines")}</p>}
      <div id="list_machines" className="cards">
        {state.machines.map((machine) => (
          <MachineCard key={machine.name} machine={machine} run={having(machine.name)} />
        ))}
      </div>
    </section>
  );
}
