// What a node of a run that goes on sees of the blackboard; first what its own ports name.
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Problem } from "../problem";
import { repeated } from "../repeated";
import { get } from "../server";
import type { TreeNode } from "./shape";

const EVERY = 2000; // ms between looks

type Values = Record<string, unknown>;

/** Keys that the ports of a node name, as in `record_name="{target}"`. */
export const keysIn = (ports: string) => [...ports.matchAll(/="[$#]?\{(\w+)\}"/g)].map(([, key]) => key ?? "");

export function BlackboardNow({ run, node }: { run: string; node: TreeNode }) {
  const { t } = useTranslation();
  const [values, setValues] = useState<Values>({});
  const [error, setError] = useState<Error | null>(null);
  const { path } = node;
  useEffect(() => {
    return repeated(
      () => get("/api/runs/{run_id}/blackboard", { run_id: run }, `node=${path}`),
      (found) => {
        setValues(found.values);
        setError(null);
      },
      (why) => {
        setValues({}); // the scheduler is away: nothing is known of it
        setError(why);
      },
      EVERY,
    );
  }, [run, path]);
  if (error !== null) {
    return <Problem id="node_blackboard" what={t("blackboard")} error={error} />;
  }
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
