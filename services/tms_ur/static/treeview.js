// A behaviour tree as Groot draws it: top down, grey, orange, green, red; each state has a mark, too.
import { button, change, draw, make, setText } from "./dom.js";
import { t } from "./strings.js";

const WIDTH = 176;
const HEIGHT = 56;
const GAP_X = 12;
const GAP_Y = 34;
const MARKS = ["", "▶", "✔", "✖"];
const WORDS = ["IDLE", "RUNNING_NODE", "SUCCESS", "FAILURE"];
const CLASSES = ["idle", "running", "success", "failure"];
const ZOOMS = [0.25, 0.35, 0.5, 0.7, 1, 1.4, 2];

function shortened(text, length) {
  return text.length > length ? `${text.slice(0, length - 1)}…` : text;
}

/** The second line: the goal of a leaf, else a name of its own, else its ports. */
function labelOf(tree, index) {
  const port = (name) => new RegExp(`${name}="([^"]*)"`).exec(tree.ports[index])?.[1];
  const goal = port("record_name") ?? port("subtask_name");
  return tree.names[index] === tree.types[index] ? goal ?? tree.ports[index] : tree.names[index];
}

/** The template that a node comes from, and the line in it; "" for a node of the task itself. */
export function templateOf(tree, index) {
  return tree.templates?.[index] ?? ""; // journals of releases without templates have no such list
}

export class TreeView {
  constructor(box) {
    this.box = box;
    this.svg = draw("svg", { role: "group", class: "tree" });
    box.append(this.svg);
    this.zoom = 1;
    this.closed = new Set();
    this.tree = null;
    this.states = "";
  }

  /** Shows another tree; its shape is the answer of /api/runs/ID/tree. */
  show(tree) {
    if (this.tree === tree) {
      return;
    }
    this.tree = tree;
    this.closed.clear();
    this.last = new Map(); // path -> last state that was not idle
    this.nodes = new Map();
    tree.paths.forEach((path, index) => {
      this.nodes.set(path, { path, index, name: tree.names[index], type: tree.types[index], kind: tree.kinds[index],
        ports: tree.ports[index], template: templateOf(tree, index), label: labelOf(tree, index), children: [] });
    });
    for (const node of this.nodes.values()) {
      this.nodes.get(node.path.slice(0, node.path.lastIndexOf(".")))?.children.push(node);
    }
    this.rebuild();
    this.fit();
  }

  rebuild() {
    this.svg.replaceChildren();
    change(this.svg, { "aria-label": t("tree_label") });
    this.drawn = new Map();
    const root = this.nodes.values().next().value;
    const size = { width: this.place(root, 0, 0), height: 0 };
    for (const { node } of this.drawn.values()) {
      size.height = Math.max(size.height, node.y + HEIGHT);
    }
    this.size = size;
    this.paint(this.states, this.current);
    this.rescale();
  }

  /** Places a node and its children from `x` on; returns their width. */
  place(node, x, depth) {
    const children = this.closed.has(node.path) ? [] : node.children;
    let width = 0;
    for (const child of children) {
      width += this.place(child, x + width, depth + 1) + GAP_X;
    }
    width = Math.max(WIDTH, width - GAP_X);
    node.x = x + (width - WIDTH) / 2;
    node.y = depth * (HEIGHT + GAP_Y);
    for (const child of children) {
      this.svg.prepend(draw("path", { class: "edge", d: `M${node.x + WIDTH / 2} ${node.y + HEIGHT} V${node.y + HEIGHT + GAP_Y / 2} ` +
        `H${child.x + WIDTH / 2} V${child.y}` }));
    }
    this.svg.append(this.box_of(node));
    return width;
  }

  box_of(node) {
    const inner = node.children.length > 0;
    const mark = draw("text", { x: WIDTH - 10, y: 23, "text-anchor": "end", class: "mark" });
    const hidden = this.closed.has(node.path) ? ` (+${node.children.length})` : "";
    const group = draw("g", { transform: `translate(${node.x} ${node.y})`, role: inner ? "button" : "img", tabindex: inner ? 0 : -1 },
      draw("rect", { width: WIDTH, height: HEIGHT, rx: node.kind === "control" ? 2 : 10 }),
      ...(node.template ? [draw("rect", { width: 6, height: HEIGHT, class: "template" })] : []),
      draw("text", { x: 10, y: 23, class: "type" }, shortened(node.type + hidden, 19)),
      draw("text", { x: 10, y: 44 }, shortened(node.label, 21)), mark,
      draw("title", {}, `${node.type} ${node.name} ${node.ports}${node.template && ` (${t("from_template", { name: node.template })})`}`));
    if (inner) {
      group.addEventListener("click", () => this.toggle(node));
      group.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          this.toggle(node);
        }
      });
    }
    this.drawn.set(node.path, { node, group, mark });
    return group;
  }

  toggle(node) {
    if (!this.closed.delete(node.path)) {
      this.closed.add(node.path);
    }
    this.rebuild();
    this.drawn.get(node.path).group.focus();
  }

  openAll() {
    this.closed.clear();
    this.rebuild();
  }

  /** `states` holds a digit a node; `current` is the path of the leaf that runs or waits. */
  paint(states, current = "") {
    this.states = states;
    this.current = current;
    if (this.tree === null) {
      return;
    }
    for (const { node } of this.nodesInOrder()) {
      const state = Number(states[node.index] ?? 0);
      if (state !== 0) {
        this.last.set(node.path, state);
      }
      const drawn = this.drawn.get(node.path);
      if (drawn !== undefined) {
        const before = state === 0 && this.last.has(node.path) ? ` was-${CLASSES[this.last.get(node.path)]}` : "";
        change(drawn.group, { class: `${CLASSES[state]}${before}${node.path === current ? " current" : ""}`,
          "data-state": CLASSES[state], "data-path": node.path,
          "aria-label": `${node.type} ${node.name}: ${t(WORDS[state])}` });
        if (node.children.length > 0) {
          change(drawn.group, { "aria-expanded": !this.closed.has(node.path) });
        }
        setText(drawn.mark, MARKS[state]);
      }
    }
  }

  nodesInOrder() {
    return [...this.nodes.values()].map((node) => ({ node }));
  }

  forget() {
    this.last?.clear();
  }

  rescale() {
    const { width, height } = this.size;
    change(this.svg, { viewBox: `-4 -4 ${width + 8} ${height + 8}`, width: (width + 8) * this.zoom, height: (height + 8) * this.zoom });
  }

  step(direction) {
    const index = ZOOMS.findIndex((zoom) => zoom >= this.zoom - 0.01);
    this.zoom = ZOOMS[Math.min(ZOOMS.length - 1, Math.max(0, (index < 0 ? ZOOMS.length - 1 : index) + direction))];
    this.rescale();
  }

  fit() {
    const room = this.box.clientWidth - 16;
    if (this.size && room > 0) {
      this.zoom = Math.min(1, Math.max(0.25, room / (this.size.width + 8)));
      this.rescale();
    }
  }
}

/** Buttons for a view. */
export function zoomBar(find) {
  return make("div", { className: "bar" }, button("zoom_in", "", () => find().step(1)), button("zoom_out", "", () => find().step(-1)),
    button("fit", "", () => find().fit()), button("expand", "", () => find().openAll()));
}
