// Side view of an excavator's arm from its joint angles: x ahead, z up, both on the turning body.

import { useTranslation } from "react-i18next";
import { Badge } from "../badge";
import type { Machine, SiteMachine } from "../models";

const SCALE = 26; // px a metre
const WIDTH = 360;
const HEIGHT = 300;
const GROUND = HEIGHT - 70;

/** Points of the arm, m: a joint's angle turns all links beyond it about y; positive is down and in. */
export function chain(arm: SiteMachine["arm"], angles: ReadonlyMap<string, number>) {
  let [turned, x, z] = [0, 0, 0];
  return arm.map((link) => {
    x += link.x * Math.cos(turned) + link.z * Math.sin(turned);
    z += -link.x * Math.sin(turned) + link.z * Math.cos(turned);
    turned += link.pitch + (link.joint === "bucket_end_joint" ? 0 : (angles.get(link.joint) ?? 0));
    return { joint: link.joint, x, z };
  });
}

export function SideView({ machine, body }: { machine: Machine; body: SiteMachine }) {
  const { t } = useTranslation();
  const angles = new Map(machine.joints.map((joint) => [joint.name, joint.position]));
  const points = chain(body.arm, angles).map(({ joint, x, z }) => ({
    joint,
    x: (80 + x * SCALE).toFixed(1),
    y: (GROUND - (1.12 + z) * SCALE).toFixed(1),
  }));
  const degrees = (angle: number) => ((angle * 180) / Math.PI).toFixed(1);
  return (
    <figure className="card">
      <svg
        className="side"
        role="img"
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        data-machine={machine.name}
        aria-label={t("side_view", { name: machine.name })}
      >
        <path className="ground" d={`M0 ${GROUND} H${WIDTH}`} />
        <rect className="body" x={20} y={HEIGHT - 132} width={74} height={52} />
        <rect className="body" x={14} y={HEIGHT - 98} width={100} height={28} rx={14} />
        <polyline className="arm" points={points.map((one) => `${one.x},${one.y}`).join(" ")} />
        {points.slice(0, -1).map((one) => (
          <circle key={one.joint} cx={one.x} cy={one.y} r={4} />
        ))}
      </svg>
      <figcaption>
        <strong>{machine.name}</strong> <Badge state={machine.state} />{" "}
        <span>{machine.joints.map((joint) => `${joint.name} ${degrees(joint.position)}°`).join(", ")}</span>
      </figcaption>
    </figure>
  );
}
