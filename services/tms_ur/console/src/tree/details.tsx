// What is known of the node that was chosen.
import { useTranslation } from "react-i18next";
import { WORDS } from "./node_box";
import type { NodeState, TreeNode } from "./shape";

export function Details({ node, state }: { node: TreeNode | undefined; state: NodeState }) {
  const { t } = useTranslation();
  if (node === undefined) {
    return null;
  }
  return (
    <aside id="node_details" className="card" aria-label={t("details")}>
      <h3>{node.type}</h3>
      <p>
        <code>{node.name}</code> {t(WORDS[state])}
      </p>
      {node.template && <p>{t("from_template", { name: node.template })}</p>}
      <table>
        <tbody>
          {[...node.ports.matchAll(/([\w-]+)="([^"]*)"/g)].map(([, name, value]) => (
            <tr key={name}>
              <th scope="row">
                <code>{name}</code>
              </th>
              <td>
                <code>{value}</code>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </aside>
  );
}
