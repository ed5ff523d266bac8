// The picture of a tree, for drawing and for the difference of two versions.
import "@xyflow/react/dist/base.css";
import "../tree/tree.css";
import "./editor.css";
import { ReactFlow, ReactFlowProvider, useReactFlow, useStore } from "@xyflow/react";
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { HEIGHT, type Placed, WIDTH } from "../tree/layout";
import { Lines } from "../tree/lines";
import { EditBox, type EditBoxNode } from "./edit_box";

const KINDS = { edit: EditBox };
const FIT = { maxZoom: 1, minZoom: 0.3, padding: 0.1 };
const SMALL = 12; // nodes
const LEGIBLE = 0.6; // zoom at which labels can be read

interface Props {
  boxes: EditBoxNode[];
  places: Placed<{ path: string }>[];
  chosen: string; // path
  label: string;
  onChoose: (path: string) => void;
}

export function Picture(props: Props) {
  return (
    <ReactFlowProvider>
      <Flow {...props} />
    </ReactFlowProvider>
  );
}

function Flow({ boxes, places, chosen, label, onChoose }: Props) {
  const { t } = useTranslation();
  const flow = useReactFlow();
  useWhole(places.length);
  useShown(places.find(({ node }) => node.path === chosen));
  return (
    <>
      <div className="treebox flow">
        <ReactFlow
          aria-label={label}
          nodes={boxes}
          nodeTypes={KINDS}
          nodesDraggable={false}
          nodesConnectable={false}
          nodesFocusable={false}
          disableKeyboardA11y
          deleteKeyCode={null}
          selectionKeyCode={null}
          minZoom={0.05}
          maxZoom={2}
          fitView={places.length <= SMALL} // of a larger one, the chosen node
          fitViewOptions={FIT}
          onlyRenderVisibleElements
          proOptions={{ hideAttribution: true }} // a link out of the site
          onNodeClick={(_, node) => onChoose(node.id)}
        >
          <Lines places={places} />
        </ReactFlow>
      </div>
      <div className="bar">
        <button type="button" onClick={() => flow.zoomIn()}>
          {t("zoom_in")}
        </button>
        <button type="button" onClick={() => flow.zoomOut()}>
          {t("zoom_out")}
        </button>
        <button type="button" onClick={() => flow.fitView(FIT)}>
          {t("fit")}
        </button>
      </div>
    </>
  );
}

/** Shows all of a small tree, also when it grows. */
function useWhole(count: number) {
  const flow = useReactFlow();
  useEffect(() => {
    if (count <= SMALL && flow.viewportInitialized) {
      flow.fitView(FIT);
    }
  }, [count, flow]);
}

/** Brings a node into the picture when it is not there. */
function useShown(place: Placed<{ path: string }> | undefined) {
  const flow = useReactFlow();
  const width = useStore((state) => state.width);
  const height = useStore((state) => state.height);
  const [x, y] = [place?.x, place?.y];
  const ready = flow.viewportInitialized && width > 0;
  useEffect(() => {
    if (x === undefined || y === undefined || !ready) {
      return;
    }
    const view = flow.getViewport();
    const [left, top] = [x * view.zoom + view.x, y * view.zoom + view.y];
    const inside = left >= 0 && top >= 0 && left + WIDTH * view.zoom <= width && top + HEIGHT * view.zoom <= height;
    if (!inside) {
      flow.setCenter(x + WIDTH / 2, y + HEIGHT / 2, { zoom: Math.max(LEGIBLE, view.zoom) });
    }
  }, [x, y, width, height, flow, ready]);
}
