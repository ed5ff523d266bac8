// The processes of every PC, essential ones apart from those on demand; the log of one opens below its row.
import { restartProcess } from "old/actions.js";
import { duration } from "old/dom.js";
import { Fragment, useState } from "react";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import { Command } from "../command";
import type { Process, State } from "../models";
import { Said } from "../said";
import { Table } from "../table";
import { ProcessLog } from "./log";
import { groupsOf, isDown, type Row } from "./rows";

const HEADS = 8; // columns
const QUIET = new Set(["RUNNING", "STOPPED"]); // states of which supervisord only tells the time

interface Props {
  state: State;
  open: string; // process whose log is shown, empty: none
  onOpen: (process: string) => void;
}

export function Processes({ state, open, onOpen }: Props) {
  const { t } = useTranslation();
  const [words, setWords] = useState("");
  const { essential, onDemand } = groupsOf(state, words);
  const shared = { running: state.runs.length, open, onOpen };
  return (
    <>
      <h2>{t("processes")}</h2>
      <label>
        {t("filter")}
        <input id="process_filter" type="search" value={words} onChange={(event) => setWords(event.target.value)} />
      </label>
      {state.hosts.length === 0 && <p id="none_processes">{t("none_processes")}</p>}
      <Group id="list_processes" label="essential_processes" rows={essential} {...shared} />
      <Group id="list_on_demand" label="on_demand_processes" rows={onDemand} {...shared} />
    </>
  );
}

interface GroupProps {
  id: string;
  label: string; // key of its heading
  rows: Row[];
  running: number; // active runs
  open: string;
  onOpen: (process: string) => void;
}

function Group({ id, label, rows, running, open, onOpen }: GroupProps) {
  const { t } = useTranslation();
  if (rows.length === 0) {
    return null;
  }
  return (
    <>
      <h3>{t(label)}</h3>
      <Table
        id={id}
        label={label}
        heads={["process", "host", "state", "uptime", "cpu", "memory", "restarts", "log"]}
        blocks
      >
        {rows.map((row) => (
          <Fragment key={`${row.host}/${row.process.name}`}>
            <Line row={row} running={running} open={open === row.process.name} onOpen={onOpen} />
            {open === row.process.name && (
              <tr>
                <td colSpan={HEADS} className="wide_lines">
                  <ProcessLog key={open} name={open} />
                </td>
              </tr>
            )}
          </Fragment>
        ))}
      </Table>
    </>
  );
}

interface LineProps {
  row: Row;
  running: number; // active runs
  open: boolean;
  onOpen: (process: string) => void;
}

function Line({ row: { host, process }, running, open, onOpen }: LineProps) {
  const { t } = useTranslation();
  const { name } = process;
  return (
    <tr data-process={name}>
      <td>{name}</td>
      <td data-label={t("host")}>{host}</td>
      <td>
        <Badge state={shownState(process)} />
        {!QUIET.has(process.state) && <Said reason={process.detail} done="logs" />}
      </td>
      <td data-label={t("uptime")}>{process.state === "RUNNING" ? duration(process.uptime) : "-"}</td>
      <td data-label={t("cpu")}>{process.pid ? `${process.cpu.toFixed(1)} %` : "-"}</td>
      <td data-label={t("memory")}>{process.pid ? `${Math.round(process.memory / 1e6)} MB` : "-"}</td>
      <td data-label={t("restarts")}>{process.restarts}</td>
      <td className="bar">
        <button
          type="button"
          aria-expanded={open}
          aria-label={t("log_of", { name })}
          onClick={() => onOpen(open ? "" : name)}
        >
          {t("log")}
        </button>
        <Command label={t("restart_process", { name })} work={() => restartProcess(name, running)}>
          {t("restart")}
        </Command>
      </td>
    </tr>
  );
}

/** One on demand that is stopped waits for work; an essential one that is stopped is a fault. */
const shownState = (process: Process) =>
  process.state === "STOPPED" ? (isDown(process) ? "down" : "on_demand") : process.state;
