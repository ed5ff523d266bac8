// What can be done with the picture of a tree: follow, zoom, open, search, durations.
import { useReactFlow } from "@xyflow/react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { HEIGHT, type Placed, WIDTH } from "./layout";
import { Search } from "./search";
import type { TreeNode } from "./shape";
import type { Spent } from "./spent";

const LEGIBLE = 0.8; // zoom at which labels can be read from an arm's length
const MOVE = { duration: 300 }; // ms

/** How long nodes took: shown when a person asks for it, since a journal must be read for it. */
export interface Timing {
  shown: boolean;
  spent: Map<number, Spent> | null; // by the index of a node; null: not shown, or not read yet
  onShow: (shown: boolean) => void;
}

interface Props {
  nodes: Map<string, TreeNode>;
  places: Placed<TreeNode>[];
  leaf: string; // path of the one that works or waits
  timing: Timing | undefined;
  onAll: () => void;
  onFound: (found: TreeNode[]) => void;
  onGo: (node: TreeNode) => void; // opens the way to it
}

const boxAt = (places: Placed<TreeNode>[], path: string) => places.find(({ node }) => node.path === path);

export function Bar({ nodes, places, leaf, timing, onAll, onFound, onGo }: Props) {
  const { t } = useTranslation();
  const flow = useReactFlow();
  const [following, setFollowing] = useState(true);
  const [sought, setSought] = useState("");
  const at = boxAt(places, following ? leaf : sought); // a sought node has a place when the way to it is open
  const [x, y] = [at?.x, at?.y];
  const low = following ? 0 : HEIGHT / 2;
  useEffect(() => {
    if (x !== undefined && y !== undefined && flow.viewportInitialized) {
      flow.setCenter(x + WIDTH / 2, y + low, { zoom: Math.max(LEGIBLE, flow.getZoom()), ...MOVE });
    }
  }, [x, y, low, flow]);
  const look = (move: () => void) => () => {
    setFollowing(false);
    setSought("");
    move();
  };
  const go = (node: TreeNode) => {
    setFollowing(false);
    setSought(node.path);
    onGo(node);
  };
  return (
    <div className="bar">
      <Toggle pressed={following} onToggle={setFollowing}>
        {t("follow")}
      </Toggle>
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
      {timing && (
        <Toggle pressed={timing.shown} onToggle={timing.onShow}>
          {t("durations")}
        </Toggle>
      )}
      <Search nodes={nodes} onFound={onFound} onGo={go} />
    </div>
  );
}

interface ToggleProps {
  pressed: boolean;
  onToggle: (pressed: boolean) => void;
  children: string;
}

function Toggle({ pressed, onToggle, children }: ToggleProps) {
  return (
    <button type="button" aria-pressed={pressed} onClick={() => onToggle(!pressed)}>
      {pressed ? "☑" : "☐"} {children}
    </button>
  );
}
