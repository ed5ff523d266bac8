// The drawing of a tree: it follows the running leaf, finished branches fold, and what is clicked on opens and tells more.
import "@xyflow/react/dist/base.css";
import "./tree.css";
import { MiniMap, ReactFlow, ReactFlowProvider, useStore } from "@xyflow/react";
import { memo, type ReactNode, useCallback, useMemo, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Tree } from "../models";
import { Bar, type Timing } from "./bar";
import { Details } from "./details";
import { type Placed, placed } from "./layout";
import { Lines } from "./lines";
import { type BoxNode, NodeBox } from "./node_box";
import { above, type NodeState, nodesOf, openPaths, stateOf, type TreeNode } from "./shape";
import { bandOf, useBoxes } from "./use_boxes";

const KINDS = { box: NodeBox };
const FIT = { maxZoom: 1, minZoom: 0.4, padding: 0.1 };
const FAR = 0.35; // zoom below which nobody can read letters

interface Props {
  tree: Tree;
  digits: string; // state of every node
  leaf: string; // path of the one that works or waits
  last: Map<number, NodeState>; // of each node by its index: the last state that was not idle
  facts: (node: TreeNode) => ReactNode; // what else is known of the node that is chosen
  timing?: Timing; // how long nodes took, on demand
}

export function TreeFlow(props: Props) {
  return (
    <ReactFlowProvider>
      <Flow {...props} />
    </ReactFlowProvider>
  );
}

/** What of a tree is shown: it changes with what is open, not with every state. */
function useShown(nodes: Map<string, TreeNode>, digits: string, byHand: Map<string, boolean>) {
  const open = useMemo(() => openPaths(nodes, digits, byHand), [nodes, digits, byHand]);
  const shape = [...open].join();
  // biome-ignore lint/correctness/useExhaustiveDependencies: `shape` is what `open` holds
  return useMemo(() => {
    const root = nodes.get("0");
    return { open, places: root === undefined ? [] : placed(root, open) };
  }, [nodes, shape]);
}

function Flow({ tree, digits, leaf, last, facts, timing }: Props) {
  const [byHand, setByHand] = useState(new Map<string, boolean>());
  const [chosen, setChosen] = useState("");
  const [found, setFound] = useState(new Set<string>());
  const nodes = useMemo(() => nodesOf(tree), [tree]);
  const { open, places } = useShown(nodes, digits, byHand);
  const machines = nodes.get("0")?.team ?? [];
  const spent = timing?.spent ?? null;
  const boxes = useBoxes(places, { digits, leaf, last, chosen, open, found, machines, spent });
  const set = useCallback(
    (paths: Iterable<string>, shown: boolean) =>
      setByHand((before) => new Map([...before, ...[...paths].map((path) => [path, shown] as const)])),
    [],
  );
  const choose = useCallback(
    (path: string) => {
      setChosen(path);
      if (nodes.get(path)?.children.length) {
        set([path], !open.has(path));
      }
    },
    [nodes, open, set],
  );
  const looked = nodes.get(chosen);
  return (
    <div className="tree_and_details">
      <div>
        <Bar
          nodes={nodes}
          places={places}
          leaf={leaf}
          timing={timing}
          onAll={() => set(nodes.keys(), true)}
          onFound={(some) => setFound(new Set(some.map((one) => one.path)))}
          onGo={({ path }) => {
            set(above(path), true);
            setChosen(path);
          }}
        />
        {machines.length > 1 && <Legend machines={machines} />}
        <Picture boxes={boxes} places={places} whole={leaf === ""} machines={machines} onChoose={choose} />
      </div>
      <Details node={looked} state={stateOf(looked ?? { index: -1 }, digits)}>
        {looked && facts(looked)}
      </Details>
    </div>
  );
}

/** Which colour is whose. */
function Legend({ machines }: { machines: string[] }) {
  const { t } = useTranslation();
  return (
    <ul className="rows legend" aria-label={t("machines")}>
      {machines.map((name) => (
        <li key={name}>
          <span className={`swatch machine-${bandOf([name], machines)}`} aria-hidden="true" /> {name}
        </li>
      ))}
    </ul>
  );
}

interface PictureProps {
  boxes: BoxNode[];
  places: Placed<TreeNode>[];
  whole: boolean; // shown as a whole at first
  machines: string[];
  onChoose: (path: string) => void;
}

const Picture = memo(function Picture({ boxes, places, whole, machines, onChoose }: PictureProps) {
  const { t } = useTranslation();
  const box = useRef<HTMLDivElement>(null);
  const far = useStore(({ transform }) => transform[2] < FAR);
  // while it moves, it is one layer that the browser shifts; afterwards it is drawn sharply
  const moves = (begun: boolean) => () => void box.current?.classList.toggle("moves", begun);
  const kindOf = useCallback(
    (node: { team?: string[] }) => `line-${machines.length > 1 ? bandOf(node.team ?? [], machines) : 0}`,
    [machines],
  );
  return (
    <div id="tree_box" ref={box} className={`treebox flow${far ? " far" : ""}`}>
      <ReactFlow
        aria-label={t("tree_label")}
        nodes={boxes}
        nodeTypes={KINDS}
        nodesDraggable={false}
        nodesConnectable={false}
        minZoom={0.05}
        maxZoom={2}
        fitView={whole}
        fitViewOptions={FIT}
        onlyRenderVisibleElements
        proOptions={{ hideAttribution: true }} // a link out of the site
        onMoveStart={moves(true)}
        onMoveEnd={moves(false)}
        onNodeClick={(_, node) => onChoose(node.id)}
      >
        <Lines places={places} kindOf={kindOf} />
        <MiniMap pannable zoomable ariaLabel={t("overview")} nodeClassName={classOf} />
      </ReactFlow>
    </div>
  );
});

const classOf = (node: { data: Record<string, unknown> }) => String(node.data.state);
