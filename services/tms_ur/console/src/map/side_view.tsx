// A machine from the side, as its joints tell: what turns about the vertical is shown straight ahead.

import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import type { Machine, SiteMachine } from "../models";
import { svgPoints } from "./outline";
import { anglesOf, links, placed, put } from "./pose";
import { type Prism, prisms } from "./shapes";

const SPAN = { x: -4.5, z: -3, width: 14.5, height: 12 }; // m: the longest arm in all its poses
const FORWARD = "y"; // the axis of joints that a view from the side shows

/** The outlines of a machine's prisms from the side, x ahead and z up, m. */
export function sideOf(body: SiteMachine, shapes: readonly Prism[], angles: ReadonlyMap<string, number>) {
  const shown = body.joints.filter((one) => one.axis === FORWARD).map((one) => one.joint);
  const frames = links(body, new Map([...angles].filter(([joint]) => shown.includes(joint))), placed(0, 0, 0));
  return shapes.flatMap((one) => {
    const frame = frames.get(one.link);
    const points = frame ? one.outline.map(([x, z]) => put(frame, [x, one.y0, z])) : [];
    return frame ? [{ role: one.role, points: points.map(([x, , z]) => [x, z] as const) }] : [];
  });
}

export function SideView({ machine, body }: { machine: Machine; body: SiteMachine }) {
  const { t } = useTranslation();
  const shapes = useMemo(() => prisms(body), [body]);
  const degrees = (angle: number) => ((angle * 180) / Math.PI).toFixed(1);
  return (
    <figure className="card">
      <svg
        className="side machine"
        role="img"
        viewBox={`${SPAN.x} ${-SPAN.z - SPAN.height} ${SPAN.width} ${SPAN.height}`}
        data-machine={machine.name}
        aria-label={t("side_view", { name: machine.name })}
      >
        <path className="ground" d={`M${SPAN.x} 0 h${SPAN.width}`} />
        {sideOf(body, shapes, anglesOf(machine)).map((one, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: the bodies of a machine do not change
          <polygon key={index} className={one.role} points={svgPoints(one.points)} />
        ))}
      </svg>
      <figcaption>
        <strong>{machine.name}</strong> <Badge state={machine.state} />{" "}
        <span>{machine.joints.map((joint) => `${joint.name} ${degrees(joint.position)}°`).join(", ")}</span>
      </figcaption>
    </figure>
  );
}
