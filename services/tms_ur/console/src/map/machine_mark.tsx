// A machine on the map: its bodies as they are now, where it heads, its name, state and lamp.

import { mark } from "old/dom.js";
import { memo, useMemo } from "react";
import { useTranslation } from "react-i18next";
import type { Machine, SiteMachine } from "../models";
import { isOld } from "./old_place";
import { shadow, svgPoints } from "./outline";
import { anglesOf, links, placed, put } from "./pose";
import { prisms } from "./shapes";

const TURNING = "z"; // the axis about which an upper body turns

interface Props {
  machine: Machine;
  body: SiteMachine;
  letters: number; // m, height of the name
}

export const MachineMark = memo(function MachineMark({ machine, body, letters }: Props) {
  const { t } = useTranslation();
  const shapes = useMemo(() => prisms(body), [body]);
  const place = machine.place;
  if (!place) {
    return null;
  }
  const frames = links(body, anglesOf(machine), placed(place.x, place.y, place.yaw));
  const known = isOld(machine) ? "silent" : machine.state; // the place is the last known one
  const upper = body.joints.find((one) => one.axis === TURNING && one.parent !== "lift_link")?.child ?? "base_link";
  const heading = frames.get(upper) ?? frames.get("base_link");
  const nose = heading ? [put(heading, [0, 0, 0]), put(heading, [4, 0, 0])] : [];
  return (
    <>
      <g className={`machine ${known}`} data-machine={machine.name}>
        {shapes.map((one, index) => {
          const frame = frames.get(one.link);
          // biome-ignore lint/suspicious/noArrayIndexKey: the bodies of a machine do not change
          return frame && <polygon key={index} className={one.role} points={svgPoints(shadow(one, frame))} />;
        })}
        <polyline className="heading" points={svgPoints(nose)} />
      </g>
      <text className="name" x={place.x + 1} y={-place.y - 3.4} fontSize={letters}>
        {machine.name} {mark(known)}
      </text>
      {machine.lamp && ( // nobody records them: the past has none
        <circle
          className={`lamp ${machine.lamp}`}
          cx={place.x + 0.4}
          cy={-place.y - 3.4 - letters * 0.35}
          r={letters * 0.3}
        >
          <title>{t(`lamp_${machine.lamp}`)}</title>
        </circle>
      )}
    </>
  );
});
