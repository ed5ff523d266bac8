// What the map cannot show: machines without a place, people, trackers and hardware.

import { duration } from "old/dom.js";
import { useTranslation } from "react-i18next";
import type { Machine, State } from "../models";
import { Said } from "../said";
import { isOld } from "./old_place";

export function Notes({ state }: { state: State }) {
  const { t } = useTranslation();
  const unsure = state.machines.filter((machine) => !machine.place || isOld(machine));
  const trackers = (state.seen ?? []).filter((one) => one.opened || one.silent);
  return (
    <>
      <ul id="unplaced" className="rows">
        {unsure.map(({ name, place, place_age: age }) => (
          <li key={name}>{t(place ? "old_place" : "no_place", { name, age: duration(age ?? null) })}</li>
        ))}
      </ul>
      <ul id="watched" className="rows">
        {state.machines.map((machine) => (
          <Watched key={machine.name} machine={machine} />
        ))}
        {trackers.map((one) => (
          <li key={one.tracker}>{t(one.opened ? "gate_open" : "tracker_silent", { name: one.tracker })}</li>
        ))}
      </ul>
    </>
  );
}

/** Who is among the machines or near, and what its hardware says that is not known or forbids motion. */
function Watched({ machine }: { machine: Machine }) {
  const { t } = useTranslation();
  const { people, hardware = {} } = machine.watched ?? {};
  const signals = Object.entries(hardware).map(([name, says]) => `${t(`hw_${name}`)}: ${t(`says_${says}`)}`);
  return (
    <>
      {people && (
        <li>
          <Said reason={people} />
        </li>
      )}
      {signals.length > 0 && (
        <li>
          {machine.name}: {signals.join(", ")}
        </li>
      )}
    </>
  );
}
