// Lines by time. Its page has the same as a table or text, since a picture is nothing for a screen reader.
import "./plot.css";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { type RefObject, useEffect, useRef } from "react";

const HEIGHT = 280; // px
const COLOURS = ["#0a6fd1", "#d35400", "#1e8449", "#8e44ad", "#b03a2e", "#117a8b", "#9a7d0a", "#5d6d7e"];
const LEAST = 0.1; // rad, m/s, m3 between bottom and top: the noise of one that stands is not to fill the plot
const DASHES = [[], [8, 4], [2, 3]]; // lines of one colour are told apart by these

export interface Line {
  name: string;
  values: (number | null)[]; // null: as before
}

interface Props {
  label: string;
  times: number[]; // s since the epoch, rising
  lines: Line[];
  cursor?: number; // s since the epoch, of what else the page shows; the lines are then measured, not written
  onChoose?: (time: number) => void; // a click asks for this time
}

export default function Plot({ label, times, lines, cursor, onChoose }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const drawn = useRef<uPlot | null>(null);
  const now = useRef({ cursor, onChoose });
  now.current = { cursor, onChoose };
  useEffect(() => {
    const here = box.current;
    if (here === null) {
      return;
    }
    const plot = new uPlot(options(here, lines, now), [times, ...lines.map((line) => line.values)], here);
    drawn.current = plot;
    const sized = new ResizeObserver(() => plot.setSize({ width: here.clientWidth, height: HEIGHT }));
    sized.observe(here);
    return () => {
      sized.disconnect();
      plot.destroy();
    };
  }, [times, lines]);
  useEffect(() => void (cursor !== undefined && drawn.current && place(drawn.current, cursor)), [cursor]);
  return <div ref={box} className="plot" role="img" aria-label={label} />;
}

/** Puts the line of the cursor, and the values of the legend, to a time. */
const place = (plot: uPlot, time: number) => plot.setCursor({ left: plot.valToPos(time, "x"), top: 0 });

type Now = RefObject<{ cursor: number | undefined; onChoose: ((time: number) => void) | undefined }>;

/** A plot whose cursor the page moves: hands only choose a time. */
function shared(now: Now): Partial<uPlot.Options> {
  if (now.current.cursor === undefined) {
    return {};
  }
  const again = (plot: uPlot) => place(plot, now.current.cursor ?? 0);
  const none = () => null;
  const mousedown = (plot: uPlot) => (event: MouseEvent) => {
    now.current.onChoose?.(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    return null;
  };
  const bind = { mousemove: none, mouseenter: none, mouseleave: none, mouseup: none, dblclick: none, mousedown };
  const range = (_: uPlot, low: number, high: number): [number, number] => {
    const more = Math.max((high - low) * 0.05, (LEAST - (high - low)) / 2);
    return [low - more, high + more];
  };
  return { cursor: { y: false, bind }, scales: { y: { range } }, hooks: { ready: [again], setSize: [again] } };
}

function options(here: HTMLElement, lines: Line[], now: Now): uPlot.Options {
  const style = getComputedStyle(here);
  const axis = {
    stroke: style.getPropertyValue("--ink"),
    grid: { stroke: style.getPropertyValue("--soft") },
    ticks: { stroke: style.getPropertyValue("--line") },
  };
  const measured = now.current.cursor !== undefined;
  const stepped = measured ? undefined : uPlot.paths.stepped?.({ align: 1 });
  return {
    width: here.clientWidth,
    height: HEIGHT,
    ...shared(now),
    axes: [axis, axis],
    series: [
      {},
      ...lines.map((line, index) => ({
        label: line.name,
        stroke: COLOURS[index % COLOURS.length] ?? "",
        dash: DASHES[Math.floor(index / COLOURS.length) % DASHES.length] ?? [],
        width: 2,
        spanGaps: true,
        points: { show: !measured },
        ...(stepped && { paths: stepped }),
      })),
    ],
  };
}
