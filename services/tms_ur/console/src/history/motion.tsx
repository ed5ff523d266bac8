// What the machines did: map or 3D, values and plots, all at the cursor of the time line.
import { lazy, Suspense, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { Downloads } from "../downloads";
import type { Recording } from "../models";
import { Table } from "../table";
import { PastMap } from "./past_map";
import { type Drawn, indexAt, machinesOf, plotsOf, seriesOf, speedsOf, valuesAt } from "./recording";

const FORMS = ["CSV", "MCAP"];
const Plot = lazy(() => import("../plot"));

interface Props {
  run: string;
  first: string; // the machine that is plotted at first, if it was recorded
  recording: Recording;
  time: number; // ms, of the cursor
  onTime: (time: number) => void;
}

export function Motion({ run, first, recording, time, onTime }: Props) {
  const { t } = useTranslation();
  const machines = machinesOf(recording);
  const [asked, setAsked] = useState("");
  const chosen = [asked, first].find((one) => machines.includes(one)) ?? machines[0] ?? "";
  const plots = useMemo(() => plotsOf(recording, chosen), [recording, chosen]);
  const seconds = time / 1000;
  return (
    <section id="motion">
      <PastMap recording={recording} seconds={seconds} />
      <Values recording={recording} seconds={seconds} />
      <div className="bar">
        <label>
          {t("machine_name")}{" "}
          <select id="plotted" value={chosen} onChange={(event) => setAsked(event.target.value)}>
            {machines.map((name) => (
              <option key={name}>{name}</option>
            ))}
          </select>
        </label>
      </div>
      <Downloads id="exports_motion" label="export_motion" files={FORMS.map((form) => [form, motionFile(run, form)])} />
      {plots.map((plot) => (
        <OnePlot key={`${chosen} ${plot.title}`} machine={chosen} plot={plot} seconds={seconds} onTime={onTime} />
      ))}
    </section>
  );
}

interface PlotProps {
  machine: string;
  plot: Drawn;
  seconds: number; // since the epoch
  onTime: (time: number) => void; // ms
}

function OnePlot({ machine, plot, seconds, onTime }: PlotProps) {
  const { t } = useTranslation();
  const title = `${machine}: ${t(plot.title)}`;
  return (
    <>
      <h4>{title}</h4>
      <Suspense>
        <Plot
          label={title}
          times={plot.times}
          lines={plot.lines}
          cursor={seconds}
          onChoose={(one) => onTime(one * 1000)}
        />
      </Suspense>
    </>
  );
}

/** The same in numbers, for all machines. */
function Values({ recording, seconds }: { recording: Recording; seconds: number }) {
  const speeds = useMemo(
    () => new Map(recording.series.filter((one) => one.kind === "pose").map((one) => [one.machine, speedsOf(one)])),
    [recording],
  );
  return (
    <Table id="list_motion" label="at_cursor" heads={["machine_name", "place_m", "speed_ms", "load_m3", "joints_rad"]}>
      {machinesOf(recording).map((name) => {
        const pose = seriesOf(recording, name, "pose");
        const [place, joints, load] = [
          valuesAt(pose, seconds)?.values,
          valuesAt(seriesOf(recording, name, "joints"), seconds)?.values,
          valuesAt(seriesOf(recording, name, "load"), seconds)?.values,
        ];
        const speed = pose && place ? speeds.get(name)?.[indexAt(pose.times, seconds)] : undefined;
        return (
          <tr key={name} data-machine={name}>
            <td>{name}</td>
            <td>{place ? `${fixed(place.get("x"))}, ${fixed(place.get("y"))}` : "-"}</td>
            <td>{fixed(speed)}</td>
            <td>{fixed(load?.get("loose"))}</td>
            <td>{[...(joints ?? [])].map(([joint, angle]) => `${joint} ${fixed(angle)}`).join(", ") || "-"}</td>
          </tr>
        );
      })}
    </Table>
  );
}

const fixed = (value: number | undefined) => (value === undefined ? "-" : value.toFixed(2));

const motionFile = (run: string, form: string) =>
  `/api/recordings/${encodeURIComponent(run)}/export?form=${form.toLowerCase()}`;
