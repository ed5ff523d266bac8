// The drawing of a tree: it follows the running leaf, finished branches fold, and what is clicked on opens and tells more.
import "@xyflow/react/dist/base.css";
import "./tree.css";
import {
  type Edge,
  MiniMap,
  type NodeHandle,
  Position,
  ReactFlow,
  ReactFlowProvider,
  useReactFlow,
} from "@xyflow/react";
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Tree } from "../models";
import { Details } from "./details";
import { HEIGHT, type Placed, placed, WIDTH } from "./layout";
import { type BoxNode, NodeBox, WORDS } from "./node_box";
import { type NodeState, nodesOf, openPaths, stateOf } from "./shape";

const KINDS = { box: NodeBox };
// Told and not measured, since nodes outside of the picture are not drawn: lines go to them, and the overview has them.
const SIZE = { width: WIDTH, height: HEIGHT };
const HANDLES: NodeHandle[] = [
  { type: "target", position: Position.Top, x: WIDTH / 2, y: 0, width: 1, height: 1 },
  { type: "source", position: Position.Bottom, x: WIDTH / 2, y: HEIGHT, width: 1, height: 1 },
];
const FIT = { maxZoom: 1, minZoom: 0.4, padding: 0.1 };
const LEGIBLE = 0.8; // zoom at which labels can be read from an arm's length
const MOVE = { duration: 300 }; // ms

interface Props {
  tree: Tree;
  digits: string; // state of every node
  leaf: string; // path of the one that works or waits
  last: Map<number, NodeState>; // of each node by its index: the last state that was not idle
}

export function TreeFlow(props: Props) {
  return (
    <ReactFlowProvider>
      <Flow {...props} />
    </ReactFlowProvider>
  );
}

function Flow({ tree, digits, leaf, last }: Props) {
  const { t } = useTranslation();
  const [byHand, setByHand] = useState(new Map<string, boolean>());
  const [chosen, setChosen] = useState("");
  const nodes = useMemo(() => nodesOf(tree), [tree]);
  const open = openPaths(nodes, digits, byHand);
  const shape = [...open].join();
  // biome-ignore lint/correctness/useExhaustiveDependencies: `shape` is what `open` holds
  const places = useMemo(() => {
    const root = nodes.get("0");
    return root === undefined ? [] : placed(root, open);
  }, [nodes, shape]);
  const boxes: BoxNode[] = places.map(({ node, x, y }) => {
    const state = stateOf(node, digits);
    const hidden = open.has(node.path) ? 0 : node.children.length;
    return {
      id: node.path,
      type: "box",
      position: { x, y },
      width: WIDTH,
      height: HEIGHT,
      measured: SIZE,
      handles: HANDLES,
      selected: node.path === chosen,
      ariaLabel: `${node.type} ${node.name}: ${t(WORDS[state])}`,
      data: { node, state, was: last.get(node.index) ?? "idle", current: node.path === leaf, hidden },
    };
  });
  const edges: Edge[] = places
    .filter(({ node }) => node.path !== "0")
    .map(({ node }) => ({
      id: node.path,
      source: node.path.slice(0, node.path.lastIndexOf(".")),
      target: node.path,
      type: "smoothstep",
      focusable: false,
    }));
  const choose = (path: string) => {
    setChosen(path);
    setByHand((before) => (nodes.get(path)?.children.length ? new Map(before).set(path, !open.has(path)) : before));
  };
  const all = () => setByHand(new Map([...nodes.keys()].map((path) => [path, true])));
  return (
    <div className="tree_and_details">
      <div>
        <Bar at={places.find(({ node }) => node.path === leaf)} onAll={all} />
        <div id="tree_box" className="treebox flow">
          <ReactFlow
            aria-label={t("tree_label")}
            nodes={boxes}
            edges={edges}
            nodeTypes={KINDS}
            nodesDraggable={false}
            nodesConnectable={false}
            minZoom={0.05}
            maxZoom={2}
            fitView={leaf === ""}
            fitViewOptions={FIT}
            onlyRenderVisibleElements
            proOptions={{ hideAttribution: true }} // a link out of the site
            onNodeClick={(_, node) => choose(node.id)}
          >
            <MiniMap pannable zoomable ariaLabel={t("overview")} nodeClassName={(node) => String(node.data.state)} />
          </ReactFlow>
        </div>
      </div>
      <Details node={nodes.get(chosen)} state={stateOf(nodes.get(chosen) ?? { index: -1 }, digits)} />
    </div>
  );
}

/** `at`: where the leaf stands that works or waits. */
function Bar({ at, onAll }: { at: Placed | undefined; onAll: () => void }) {
  const { t } = useTranslation();
  const flow = useReactFlow();
  const [following, setFollowing] = useState(true);
  useEffect(() => {
    if (following && at !== undefined && flow.viewportInitialized) {
      flow.setCenter(at.x + WIDTH / 2, at.y, { zoom: Math.max(LEGIBLE, flow.getZoom()), ...MOVE });
    }
  }, [following, at, flow]);
  const look = (move: () => void) => () => {
    setFollowing(false);
    move();
  };
  return (
    <div className="bar">
      <button type="button" aria-pressed={following} onClick={() => setFollowing(!following)}>
        {following ? "☑" : "☐"} {t("follow")}
      </button>
      <button type="button" onClick={look(() => flow.zoomIn(MOVE))}>
        {t("zoom_in")}
      </button>
      <button type="button" onClick={look(() => flow.zoomOut(MOVE))}>
        {t("zoom_out")}
      </button>
      <button type="button" onClick={look(() => flow.fitView({ ...MOVE, padding: 0.05 }))}>
        {t("fit")}
      </button>
      <button type="button" onClick={look(onAll)}>
        {t("expand")}
      </button>
    </div>
  );
}
