// What is known of the node that was chosen.
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { WORDS } from "./node_box";
import type { NodeState, TreeNode } from "./shape";

interface Props {
  node: TreeNode | undefined;
  state: NodeState;
  children: ReactNode; // what else is known of it
}

export function Details({ node, state, children }: Props) {
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
      {children}
    </aside>
  );
}
