// The lines between the boxes of a tree, as one picture a machine: an element for each line made a large tree stick.
import { ViewportPortal } from "@xyflow/react";
import { memo, useMemo } from "react";
import { HEIGHT, type Placed, WIDTH } from "./layout";

interface Branch {
  path: string;
  team?: string[]; // machines that work below it
}

/** A line to each box from its parent's, down, across and down; those of a kind in one path. */
export function linesTo(places: readonly Placed<Branch>[], kindOf: (node: Branch) => string): Map<string, string> {
  const known = new Map(places.map((place) => [place.node.path, place]));
  const lines = new Map<string, string>();
  for (const { node, x, y } of places) {
    const parent = known.get(node.path.slice(0, node.path.lastIndexOf(".")));
    if (parent !== undefined && parent.node !== node) {
      const [from, to] = [parent.x + WIDTH / 2, x + WIDTH / 2];
      const bottom = parent.y + HEIGHT;
      const line = `M${from} ${bottom}V${(bottom + y) / 2}H${to}V${y}`;
      const kind = kindOf(node);
      lines.set(kind, (lines.get(kind) ?? "") + line);
    }
  }
  return lines;
}

const PLAIN = () => "";

/** `kindOf`: the class of the line to a node; it must not change from one drawing to the next. */
export const Lines = memo(function Lines(props: {
  places: readonly Placed<Branch>[];
  kindOf?: (node: Branch) => string;
}) {
  const { places, kindOf = PLAIN } = props;
  const lines = useMemo(() => linesTo(places, kindOf), [places, kindOf]);
  return (
    <ViewportPortal>
      <svg className="tree_lines" aria-hidden="true">
        {[...lines].map(([kind, line]) => (
          <path key={kind} className={kind} d={line} />
        ))}
      </svg>
    </ViewportPortal>
  );
});
