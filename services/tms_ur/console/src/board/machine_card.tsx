// One machine: what it does, for whom it waits and since when, whether it may move, and what one can do about it.

import { giveBack, rearmMachine } from "old/actions.js";
import { duration } from "old/dom.js";
import { siteNow, treeOf } from "old/server.js";
import { stop } from "old/stop.js";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { Command } from "../command";
import type { ActiveRun, Machine } from "../models";
import { Said } from "../said";
import { said, timeOfDay } from "../texts";
import { doingOf } from "./doing";
import { Joints } from "./joints";

interface Props {
  machine: Machine;
  run: ActiveRun | undefined; // that has the machine
}

const armedState = (machine: Machine) =>
  machine.by_hand ? "by_hand" : machine.latch ? "latched" : machine.hold ? "held" : "armed";

export function MachineCard({ machine, run }: Props) {
  const { t } = useTranslation();
  const { name } = machine;
  return (
    <article className="card machine_card" data-machine={name} data-armed={armedState(machine)}>
      <div className="machine_head">
        <h3>{name}</h3>
        {/* Above all that changes, which must not move it from under a pointer. */}
        <button type="button" className="stop" aria-label={t("stop_machine", { name })} onClick={() => stop(name)}>
          {t("stop_one")}
        </button>
      </div>
      <Badge state={machine.state} />
      {machine.state !== "silent" && <Badge state={armedState(machine)} />}
      <Why machine={machine} run={run} />
      {run && <Work machine={machine} run={run} />}
      {machine.load && <Carried load={machine.load} />}
      <p className="small">
        <Proof machine={machine} />{" "}
        <span data-part="age">
          {t("data_age")}: {duration(machine.joint_age ?? null)}
        </span>
      </p>
      <div className="bar">
        {machine.latch && (
          <Command className="go" label={t("rearm_machine", { name })} work={() => rearmMachine(name)}>
            {t("rearm")}
          </Command>
        )}
        {machine.by_hand && (
          <Command className="go" label={t("give_back_machine", { name })} work={() => giveBack(name)}>
            {t("give_back")}
          </Command>
        )}
      </div>
      <Joints joints={machine.joints} />
    </article>
  );
}

/** Why it may not move, is not ready, or waits; each with what helps. */
function Why({ machine, run }: Props) {
  const { t } = useTranslation();
  const from = (moment: string | null | undefined) =>
    moment ? ` (${t("since", { time: timeOfDay(moment, siteNow()) })})` : "";
  const since = from(machine.since);
  const latch = machine.latch && t("why_latched", { cause: said(machine.latch) }) + since;
  const waits = run?.reason && machine.state !== "moving" && !machine.latch;
  return (
    <>
      {machine.by_hand && <p>{t("who_drives", { name: machine.by_hand }) + since}</p>}
      {latch && (
        <p className="bad">
          <Said reason={machine.latch} text={latch} done="rearm" />
        </p>
      )}
      {machine.reason && (
        <p>
          <Said reason={machine.reason} text={said(machine.reason) + since} done="rearm" />
        </p>
      )}
      {machine.watched.people && (
        <p className="bad">
          <Said reason={machine.watched.people} />
        </p>
      )}
      {machine.hold && (
        <p>
          <Said reason={machine.hold} text={said(machine.hold) + since} />
        </p>
      )}
      {waits && (
        <p>
          <Said reason={run.reason} text={t("waits", { reason: said(run.reason) }) + from(run.reason_since)} />
        </p>
      )}
    </>
  );
}

/** The task that has the machine, and the subtask that moves it now. */
function Work({ machine, run }: { machine: Machine; run: ActiveRun }) {
  const { t } = useTranslation();
  return (
    <p>
      <a className="button" href={`#tree/${encodeURIComponent(run.run_id)}`}>
        {t("task")} {run.task_id}
      </a>{" "}
      {doingOf(machine.name, run, treeOf(run.run_id)).map((one) => (
        <span key={one.subtask + one.record}>
          <code>
            {one.subtask} {one.record}
          </code>{" "}
        </span>
      ))}
    </p>
  );
}

/** Soil in the bucket or the vessel. */
function Carried({ load: { loose, capacity, mass, measured } }: { load: NonNullable<Machine["load"]> }) {
  const { t } = useTranslation();
  const figures = { loose: loose.toFixed(2), capacity: capacity.toFixed(2), mass: (mass / 1000).toFixed(2) };
  return (
    <p data-part="load">
      <label>
        {t("load")} <progress max={capacity} value={Math.min(loose, capacity)} />
      </label>{" "}
      {t(measured ? "load_measured" : "load_estimated", figures)}
    </p>
  );
}

/** The last stop, and whether it was seen to be one. */
function Proof({ machine }: { machine: Machine }) {
  const { t } = useTranslation();
  const last = machine.last_stop;
  if (!last) {
    return null;
  }
  const time = last.stamp ? timeOfDay(last.stamp, siteNow()) : "-";
  return <span>{t(last.confirmed ? "seen_to_stand" : "not_seen_to_stand", { time })}</span>;
}
