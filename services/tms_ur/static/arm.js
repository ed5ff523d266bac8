// Side view of an excavator's arm from its joint angles: x ahead, z up, both on the turning body.
import { change, draw } from "./dom.js";
import { t } from "./strings.js";

const SCALE = 26; // px a metre
const WIDTH = 360;
const HEIGHT = 300;

/** Points of the arm, m: a joint's angle turns all links beyond it about y; positive is down and in. */
export function chain(arm, angles) {
  let turned = 0;
  let x = 0;
  let z = 0;
  return arm.map((link) => {
    x += link.x * Math.cos(turned) + link.z * Math.sin(turned);
    z += -link.x * Math.sin(turned) + link.z * Math.cos(turned);
    turned += link.pitch + (link.joint === "bucket_end_joint" ? 0 : angles[link.joint] ?? 0);
    return { joint: link.joint, x, z };
  });
}

export function buildArm(machine) {
  const arm = draw("polyline", { class: "arm" });
  const picture = draw("svg", { class: "side", role: "img", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, "data-machine": machine.name },
    draw("path", { class: "ground", d: `M0 ${HEIGHT - 70} H${WIDTH}` }),
    draw("rect", { class: "body", x: 20, y: HEIGHT - 132, width: 74, height: 52 }), draw("rect", { class: "body", x: 14, y: HEIGHT - 98, width: 100, height: 28, rx: 14 }),
    arm, draw("g", { class: "joints" }));
  return picture;
}

export function fillArm(picture, machine, shape) {
  change(picture, { "aria-label": t("side_view", { name: machine.name }) });
  const angles = Object.fromEntries(machine.joints.map((joint) => [joint.name, joint.position]));
  const points = chain(shape.arm, angles).map(({ x, z }) => [80 + x * SCALE, HEIGHT - 70 - (1.12 + z) * SCALE]);
  change(picture.querySelector(".arm"), { points: points.map((point) => point.map((one) => one.toFixed(1)).join(",")).join(" ") });
  picture.querySelector(".joints").replaceChildren(
    ...points.slice(0, -1).map(([x, y]) => draw("circle", { cx: x.toFixed(1), cy: y.toFixed(1), r: 4 })));
}
