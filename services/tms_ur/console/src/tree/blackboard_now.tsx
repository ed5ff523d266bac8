// What a node of a run that goes on sees of the blackboard; first what its own ports name.
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { get } from "../server";
import type { TreeNode } from "./shape";

const EVERY = 2000; // ms between looks

type Values = Record<string, unknown>;

/** Keys that the ports of a node name, as in `record_name="{target}"`. */
export const keysIn = (ports: string) => [...ports.matchAll(/="[$#]?\{(\w+)\}"/g)].map(([, key]) => key ?? "");

export function BlackboardNow({ run, node }: { run: string; node: TreeNode }) {
  const { t } = useTranslation();
  const [values, setValues] = useState<Values>({});
  const { path } = node;
  useEffect(() => {
    let left = false;
    const look = () =>
      get("/api/runs/{run_id}/blackboard", { run_id: run }, `node=${path}`).then(
        (found) => left || setValues(found.values),
        () => left || setValues({}), // the scheduler is away: nothing is known of it
      );
    look();
    const timer = setInterval(look, EVERY);
    return () => {
      left = true;
      clearInterval(timer);
    };
  }, [run, path]);
  const own = keysIn(node.ports);
  const keys = [...new Set([...own.filter((key) => key in values), ...Object.keys(values).sort()])];
  return keys.length === 0 ? null : (
    <details id="node_blackboard" open={own.length > 0}>
      <summary>
        {t("blackboard")} ({keys.length})
      </summary>
      <dl className="entries">
        {keys.map((key) => (
          <div key={key}>
            <dt>
              <code>{key}</code>
            </dt>
            <dd>
              <code>{JSON.stringify(values[key])}</code>
            </dd>
          </div>
        ))}
      </dl>
    </details>
  );
}
