// Areas that are being drawn, over those that count now: what only one of them covers is to be seen.

import type { Draft } from "./area_draft";
import type { Area } from "./areas";
import { svgPoints } from "./outline";

interface Props {
  draft: Draft;
  enabled: Area[];
  letters: number; // m, height of names
}

export function DraftMarks({ draft, enabled, letters }: Props) {
  const chosen = draft.areas[draft.area];
  return (
    <g className="draft">
      {enabled.map((one) => (
        <polygon key={one.id} className="before" points={svgPoints(one.corners)} />
      ))}
      {draft.areas.map((one) => (
        <polygon key={one.id} className={`area ${one.type}`} data-draft={one.id} points={svgPoints(one.corners)} />
      ))}
      {chosen?.corners.map(([x, y], index) => (
        <circle
          // biome-ignore lint/suspicious/noArrayIndexKey: corners have no other name
          key={index}
          className={index === draft.corner ? "corner taken" : "corner"}
          cx={x}
          cy={-y}
          r={letters * 0.5}
        />
      ))}
    </g>
  );
}
