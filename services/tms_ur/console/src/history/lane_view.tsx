// The lanes of the machines under the slider, with the stops and the cursor.
import { useTranslation } from "react-i18next";
import { beginOf, type Journal } from "../journal/journal";
import { WORDS } from "../tree/node_box";
import { type Bar, type Lane, lanesOf, stopsOf } from "./lanes";

const WIDE = 1000; // units of a picture
const HIGH = 20;

interface Props {
  journal: Journal;
  end: number; // ms, of the time line
  time: number; // ms, of the cursor
  onTime: (time: number) => void;
}

export function LaneView({ journal, end, time, onTime }: Props) {
  const begin = beginOf(journal);
  const long = Math.max(1, end - begin);
  const at = (moment: number) => ((moment - begin) / long) * WIDE;
  const stops = stopsOf(journal).map(at);
  const chosen = (event: React.MouseEvent) => {
    const box = event.currentTarget.getBoundingClientRect();
    onTime(begin + (long * (event.clientX - box.left)) / box.width);
  };
  return (
    <div id="lanes">
      {lanesOf(journal).map((lane) => (
        <Row key={lane.machine} lane={lane} at={at} stops={stops} cursor={at(time)} onChoose={chosen} />
      ))}
    </div>
  );
}

interface RowProps {
  lane: Lane;
  at: (time: number) => number; // of a time in the picture
  stops: number[];
  cursor: number;
  onChoose: (event: React.MouseEvent) => void;
}

function Row({ lane, at, stops, cursor, onChoose }: RowProps) {
  return (
    <div className="lane" data-lane={lane.machine}>
      <span>{lane.machine}</span>
      {/* biome-ignore lint/a11y/useKeyWithClickEvents: the slider above does the same for the keyboard */}
      <svg
        viewBox={`0 0 ${WIDE} ${HIGH}`}
        preserveAspectRatio="none"
        role="img"
        aria-label={lane.machine}
        onClick={onChoose}
      >
        {lane.bars.map((bar) => (
          <BarBox key={bar.event} bar={bar} from={at(bar.begin)} to={bar.end === null ? WIDE : at(bar.end)} />
        ))}
        {stops.map((stop) => (
          <path key={stop} className="stop_mark" d={`M${stop} 0 V${HIGH}`} />
        ))}
        <path className="cursor_mark" d={`M${cursor} 0 V${HIGH}`} />
      </svg>
    </div>
  );
}

const TOPS = { idle: 12, running: 8, success: 8, failure: 0 }; // a failure is told by its height, too

function BarBox({ bar, from, to }: { bar: Bar; from: number; to: number }) {
  const { t } = useTranslation();
  const top = TOPS[bar.state];
  return (
    <rect className={`bar_box ${bar.state}`} x={from} y={top} width={Math.max(1, to - from)} height={HIGH - top}>
      <title>{`${bar.label}: ${t(WORDS[bar.state])}`}</title>
    </rect>
  );
}
