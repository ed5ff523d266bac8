// Work: what the machines have moved on a day, beside what was planned for it.
import { useCallback } from "react";
import { useTranslation } from "react-i18next";
import { Downloads } from "../downloads";
import type { Work, WorkSum } from "../models";
import { Problem } from "../problem";
import { get } from "../server";
import { Table } from "../table";
import { useRepeated } from "../use_repeated";
import { dayBeside, hoursOf, partsOf } from "./days";
import "./work.css";

const EVERY = 30_000; // ms between two looks at today
const HEADS = ["cycles", "bank_m3", "loose_m3", "mass_t", "fill", "truck_loads", "km", "bank_per_hour", "cycle_s"];

/** `rest`: a day, empty for today. */
export default function WorkPage({ rest }: { rest: string }) {
  const { t, i18n } = useTranslation();
  const ask = useCallback(() => get("/api/work", {}, rest && `day=${rest}`), [rest]);
  const { found: work, error } = useRepeated(ask, rest === "" ? EVERY : null);
  const report = (day: string, form: string) => `/api/work/report?day=${day}&form=${form}&language=${i18n.language}`;
  return (
    <>
      <h2>
        {t("p_work")} <span className="paper">{work?.day}</span>
      </h2>
      <Problem id="work_problem" error={error} />
      {work && <Days day={work.day} />}
      {work && (
        <Downloads
          id="daily_report"
          label="daily_report"
          files={["PDF", "HTML"].map((form) => [form, report(work.day, form.toLowerCase())] as const)}
        />
      )}
      {work && <Figures work={work} />}
    </>
  );
}

function Days({ day }: { day: string }) {
  const { t } = useTranslation();
  const show = (next: string) => {
    location.hash = `#work/${next}`;
  };
  return (
    <div className="bar">
      <button type="button" onClick={() => show(dayBeside(day, -1))}>
        {t("day_before")}
      </button>
      <label>
        {t("day")}{" "}
        <input type="date" id="day" value={day} onChange={(event) => event.target.value && show(event.target.value)} />
      </label>
      <button type="button" onClick={() => show(dayBeside(day, 1))}>
        {t("day_after")}
      </button>
      <a className="button" href="#work">
        {t("today")}
      </a>
    </div>
  );
}

function Figures({ work }: { work: Work }) {
  const { t } = useTranslation();
  const { total, plan } = work;
  if (total.cycles + total.loads === 0 && plan === null) {
    return <p id="none_work">{t("none_work")}</p>;
  }
  return (
    <>
      {plan && <Plan what="bank_m3" done={total.bank} planned={plan.bank} digits={1} />}
      {plan && typeof plan.loads === "number" && (
        <Plan what="truck_loads" done={total.loads} planned={plan.loads} digits={0} />
      )}
      <h3>{t("by_machine")}</h3>
      <Table id="list_work" label="by_machine" heads={["machine", ...HEADS]}>
        {[...work.machines, { ...total, name: t("all_together") }].map((one) => (
          <Row key={one.name} one={one} />
        ))}
      </Table>
      <h3>{t("by_hour")}</h3>
      <Table id="list_hours" label="by_hour" heads={["hour", "cycles", "bank_m3", "truck_loads", "share"]}>
        {hoursOf(work.hours).map(({ one, share }) => (
          <tr key={one.name}>
            <th scope="row">{`${one.name}:00`}</th>
            <td>{one.cycles}</td>
            <td>{one.bank.toFixed(2)}</td>
            <td>{one.loads}</td>
            <td>
              <progress max={1} value={share} aria-label={`${one.name}:00`} />
            </td>
          </tr>
        ))}
      </Table>
      <h3>{t("by_part")}</h3>
      <Table id="list_parts" label="by_part" heads={["part", "minutes", "share"]}>
        {partsOf(total.parts).map(({ name, minutes, share }) => (
          <tr key={name}>
            <th scope="row">{t(`part_${name}`)}</th>
            <td>{minutes.toFixed(1)}</td>
            <td>{`${Math.round(share * 100)} %`}</td>
          </tr>
        ))}
      </Table>
      {total.unseen > 0 && <p className="warn">{t("work_unseen", { minutes: (total.unseen / 60).toFixed(1) })}</p>}
      <p className="small">{t("work_note")}</p>
    </>
  );
}

interface PlanProps {
  what: string; // key
  done: number;
  planned: number;
  digits: number;
}

function Plan({ what, done, planned, digits }: PlanProps) {
  const { t } = useTranslation();
  const numbers = { done: done.toFixed(digits), planned: planned.toFixed(digits) };
  return (
    <p className="plan" data-plan={what}>
      <label>
        {t(what)} <progress max={planned} value={Math.min(done, planned)} />
      </label>{" "}
      {t("of_plan", { ...numbers, percent: Math.round((done / planned) * 100) })}
    </p>
  );
}

const orDash = (value: number | null, digits: number) => (value === null ? "-" : value.toFixed(digits));

function Row({ one }: { one: WorkSum }) {
  const cells = [
    one.cycles,
    one.bank.toFixed(2),
    one.loose.toFixed(2),
    (one.mass / 1000).toFixed(2),
    orDash(one.fill, 2),
    one.loads,
    (one.distance / 1000).toFixed(2),
    orDash(one.rate, 1),
    orDash(one.mean_cycle, 1),
  ];
  return (
    <tr>
      <th scope="row">{one.name}</th>
      {cells.map((cell, index) => (
        <td key={HEADS[index]}>{cell}</td>
      ))}
    </tr>
  );
}
