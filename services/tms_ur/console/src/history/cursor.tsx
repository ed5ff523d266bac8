// The cursor of the time line: a slider in tenths of a second, play with a speed, the stops, and a link to the moment.
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { beginOf, type Journal } from "../journal/journal";
import { clock } from "../texts";
import { stopsOf } from "./lanes";

const STEP = 100; // ms, of the slider and between pictures of play
const SPEEDS = [1, 4, 16, 60];

interface Props {
  run: string;
  journal: Journal;
  end: number; // ms since the epoch, of the time line
  time: number; // ms since the epoch
  onTime: (time: number) => void;
}

export function Cursor({ run, journal, end, time, onTime }: Props) {
  const { t } = useTranslation();
  const begin = beginOf(journal);
  const shown = clock(new Date(time).toISOString());
  const seconds = ((time - begin) / 1000).toFixed(1);
  return (
    <>
      <div className="bar">
        <Play time={time} end={end} onTime={onTime} />
        <Jumps stops={stopsOf(journal)} time={time} onTime={onTime} />
        <a className="button" href={`#history/${encodeURIComponent(run)}/${seconds}`}>
          {t("moment_link")}
        </a>
        <output id="moment">{shown}</output>
      </div>
      <div className="lane">
        <label htmlFor="slider">{t("timeline")}</label>
        <input
          type="range"
          id="slider"
          min={0}
          max={Math.ceil((end - begin) / STEP)}
          value={Math.round((time - begin) / STEP)}
          aria-valuetext={shown}
          onChange={(event) => onTime(begin + Number(event.target.value) * STEP)}
        />
      </div>
    </>
  );
}

function Play({ time, end, onTime }: { time: number; end: number; onTime: (time: number) => void }) {
  const { t } = useTranslation();
  const [speed, setSpeed] = useState(1);
  const [playing, setPlaying] = useState(false);
  const ended = time >= end;
  useEffect(() => {
    if (!playing || ended) {
      return;
    }
    const timer = setTimeout(() => onTime(Math.min(end, time + STEP * speed)), STEP);
    return () => clearTimeout(timer);
  }, [playing, ended, time, end, speed, onTime]);
  return (
    <>
      <button type="button" id="play" aria-pressed={playing && !ended} onClick={() => setPlaying(ended || !playing)}>
        {playing && !ended ? `⏸ ${t("pause_play")}` : `▶ ${t("play")}`}
      </button>
      <label>
        {t("speed")}
        <select id="speed" value={speed} onChange={(event) => setSpeed(Number(event.target.value))}>
          {SPEEDS.map((one) => (
            <option key={one} value={one}>
              ×{one}
            </option>
          ))}
        </select>
      </label>
    </>
  );
}

function Jumps({ stops, time, onTime }: { stops: number[]; time: number; onTime: (time: number) => void }) {
  const { t } = useTranslation();
  const before = stops.findLast((stop) => stop < time);
  const next = stops.find((stop) => stop > time);
  return (
    <>
      <button type="button" disabled={before === undefined} onClick={() => before !== undefined && onTime(before)}>
        {t("stop_before")}
      </button>
      <button type="button" disabled={next === undefined} onClick={() => next !== undefined && onTime(next)}>
        {t("stop_next")}
      </button>
    </>
  );
}
