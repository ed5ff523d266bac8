// Lines by time. Its page has the same as a table or text, since a picture is nothing for a screen reader.
import "./plot.css";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { useEffect, useRef } from "react";

const HEIGHT = 280; // px
const COLOURS = ["#0a6fd1", "#d35400", "#1e8449", "#8e44ad", "#b03a2e", "#117a8b", "#9a7d0a", "#5d6d7e"];
const DASHES = [[], [8, 4], [2, 3]]; // lines of one colour are told apart by these

export interface Line {
  name: string;
  values: (number | null)[]; // null: as before
}

interface Props {
  label: string;
  times: number[]; // s since the epoch, rising
  lines: Line[];
}

export default function Plot({ label, times, lines }: Props) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const here = box.current;
    if (here === null) {
      return;
    }
    const plot = new uPlot(options(here, lines), [times, ...lines.map((line) => line.values)], here);
    const sized = new ResizeObserver(() => plot.setSize({ width: here.clientWidth, height: HEIGHT }));
    sized.observe(here);
    return () => {
      sized.disconnect();
      plot.destroy();
    };
  }, [times, lines]);
  return <div ref={box} className="plot" role="img" aria-label={label} />;
}

function options(here: HTMLElement, lines: Line[]): uPlot.Options {
  const style = getComputedStyle(here);
  const axis = {
    stroke: style.getPropertyValue("--ink"),
    grid: { stroke: style.getPropertyValue("--soft") },
    ticks: { stroke: style.getPropertyValue("--line") },
  };
  const stepped = uPlot.paths.stepped?.({ align: 1 });
  return {
    width: here.clientWidth,
    height: HEIGHT,
    axes: [axis, axis],
    series: [
      {},
      ...lines.map((line, index) => ({
        label: line.name,
        stroke: COLOURS[index % COLOURS.length] ?? "",
        dash: DASHES[Math.floor(index / COLOURS.length) % DASHES.length] ?? [],
        width: 2,
        spanGaps: true,
        points: { show: true },
        ...(stepped && { paths: stepped }),
      })),
    ],
  };
}
