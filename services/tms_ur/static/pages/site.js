// Site: a map with machines and goal poses, and the arms from the side.
import { areaMarks, loadAreas, spotMark, spots } from "../areas.js";
import { buildArm, fillArm } from "../arm.js";
import { at, change, draw, duration, heading, keep, make, mark, number, part, parts, setBadge, setText } from "../dom.js";
import { ask, treeOf } from "../server.js";
import { said, t } from "../strings.js";

const GRID = 5; // m
const MARGIN = 6; // m around everything
const PLACE_OLD = 5; // s without /tf: the machine may have driven on
let shapes = null;
let goals = [];

export function build(root) {
  root.append(
    heading("map"), make("p", { data: { t: "map_note" } }), make("ul", { id: "unplaced", className: "rows" }),
    make("ul", { id: "watched", className: "rows" }),
    make("div", { id: "map_box", className: "mapbox" }), make("div", { id: "arms", className: "cards" }),
  );
  at("map_box").append(draw("svg", { id: "map", role: "img", "aria-label": t("map") }));
}

export async function load() {
  try {
    shapes ??= Object.fromEntries((await ask("/api/site")).machines.map((machine) => [machine.name, machine]));
    await loadAreas();
    goals = (await ask("/api/parameters")).flatMap(poses);
  } catch {
    // the map works without records; the next load asks again
  }
}

/** Points that a record holds: one pose or a path, with the record's name. */
function poses(record) {
  const { x, y } = record.values;
  const pairs = Array.isArray(x) && Array.isArray(y) ? x.map((one, index) => [one, y[index]]) : [[x, y]];
  return pairs.filter((pair) => pair.every(Number.isFinite)).map(([px, py], index) => (
    { x: px, y: py, model: record.model_name, record: record.record_name, index }));
}

export function update(state) {
  if (shapes === null) {
    return;
  }
  const placed = state.machines.filter((machine) => machine.place !== null);
  const unsure = state.machines.filter((machine) => machine.place === null || isOld(machine));
  keep(at("unplaced"), unsure, (machine) => machine.name, () => make("li"), (row, machine) => setText(row, tellPlace(machine)));
  const wanted = new Set(state.runs.map(currentRecord));
  const points = goals.filter((goal) => wanted.has(goal.record) && state.machines.some((machine) => machine.name === goal.model));
  drawMap(placed, points, spots(state));
  const told = state.machines.flatMap((machine) => warnings(machine).map((text, index) => ({ text, name: `${machine.name} ${index}` })));
  told.push(...state.seen.filter((one) => one.opened || one.silent).map((one) => ({ text: t(one.opened ? "gate_open" : "tracker_silent", { name: one.tracker }), name: one.tracker })));
  keep(at("watched"), told, (one) => one.name, () => make("li"), (row, one) => setText(row, one.text));
  const armed = state.machines.filter((machine) => shapes[machine.name]?.arm.length > 1 && machine.joints.length > 0);
  keep(at("arms"), armed, (machine) => machine.name, (machine) => make("figure", { className: "card" }, buildArm(machine), make("figcaption", {}, ...parts("strong", ["name"]), ...parts("span", ["state", "joints"]))), fillFigure);
}

/** Who is among the machines or near, and what its hardware says that is not known or forbids motion. */
function warnings(machine) {
  const { people, hardware } = machine.watched;
  const signals = Object.entries(hardware).map(([name, says]) => `${t(`hw_${name}`)}: ${t(`says_${says}`)}`);
  return [...(people === null ? [] : [said(people)]), ...(signals.length > 0 ? [`${machine.name}: ${signals.join(", ")}`] : [])];
}

const isOld = (machine) => machine.place_age > PLACE_OLD;

function tellPlace(machine) {
  return t(machine.place === null ? "no_place" : "old_place", { name: machine.name, age: duration(machine.place_age) });
}

function fillFigure(figure, machine) {
  fillArm(figure.firstChild, machine, shapes[machine.name]);
  setText(part(figure, "name"), machine.name);
  setBadge(part(figure, "state"), machine.state);
  setText(part(figure, "joints"), machine.joints.map((joint) => `${joint.name} ${number((joint.position * 180) / Math.PI, 1)}°`).join(", "));
}

/** Record of the running leaf, from its port. */
function currentRecord(run) {
  const tree = treeOf(run.run_id);
  const index = tree?.paths.indexOf(run.leaf) ?? -1;
  return index < 0 ? undefined : /record_name="([^"]*)"/.exec(tree.ports[index])?.[1];
}

function drawMap(machines, points, people) {
  const map = at("map");
  const all = [...machines.map((machine) => machine.place), ...points, ...people];
  const xs = all.length > 0 ? all.map((one) => one.x) : [0];
  const ys = all.length > 0 ? all.map((one) => one.y) : [0];
  const left = Math.floor((Math.min(...xs) - MARGIN) / GRID) * GRID;
  const right = Math.ceil((Math.max(...xs) + MARGIN) / GRID) * GRID;
  const low = Math.floor((Math.min(...ys) - MARGIN) / GRID) * GRID;
  const high = Math.ceil((Math.max(...ys) + MARGIN) / GRID) * GRID;
  const names = machines.map((machine) => `${machine.name} (${machine.place.x}, ${machine.place.y})`).join("; ");
  change(map, { viewBox: `${left} ${-high} ${right - left} ${high - low}`, "aria-label": `${t("map")}: ${names}` });
  map.replaceChildren(...areaMarks(), ...grid(left, right, low, high), ...people.map(spotMark), ...points.map(goalMark), ...machines.flatMap(machineMark));
}

function grid(left, right, low, high) {
  const lines = [];
  for (let x = left; x <= right; x += GRID) {
    lines.push(draw("path", { class: x === 0 ? "axis" : "grid", d: `M${x} ${-high} V${-low}` }));
  }
  for (let y = low; y <= high; y += GRID) {
    lines.push(draw("path", { class: y === 0 ? "axis" : "grid", d: `M${left} ${-y} H${right}` }));
  }
  return lines;
}

function goalMark(goal) {
  return draw("g", { class: "goal", transform: `translate(${goal.x} ${-goal.y})` }, draw("circle", { r: 0.4 }),
    draw("text", { x: 0.6, y: 0.3 }, goal.index === 0 ? goal.record : String(goal.index + 1)));
}

function machineMark(machine) {
  const { x, y, yaw } = machine.place;
  const boxes = shapes[machine.name].footprint.map((box) => draw("rect", {
    x: box.min[0], y: -box.max[1], width: box.max[0] - box.min[0], height: box.max[1] - box.min[1] }));
  const known = isOld(machine) ? "silent" : machine.state; // the place is the last known one
  const swing = machine.joints.find((joint) => joint.name === "swing_joint")?.position ?? 0;
  return [
    draw("g", { class: `machine ${known}`, "data-machine": machine.name,
      transform: `translate(${x} ${-y}) rotate(${(-yaw * 180) / Math.PI})` }, ...boxes,
    draw("path", { class: "heading", d: "M0 0 H4 M3 -0.7 L4 0 L3 0.7", transform: `rotate(${(-swing * 180) / Math.PI})` })),
    draw("text", { class: "name", x: x + 1, y: -y - 3.4 }, `${machine.name} ${mark(known)}`),
    draw("circle", { class: `lamp ${machine.lamp}`, cx: x + 0.4, cy: -y - 3.7, r: 0.4 }, draw("title", {}, t(`lamp_${machine.lamp}`))),
  ];
}
