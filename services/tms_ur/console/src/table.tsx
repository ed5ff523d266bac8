// A table that scrolls in a region of its own.
import "./table.css";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";

interface Props {
  id: string; // of its body
  label: string; // key of its name, which distinguishes it from other tables of the page
  heads: string[]; // keys
  blocks?: boolean; // on a phone each row is a block; its cells say in data-label what they are
  children: ReactNode; // rows
}

export function Table({ id, label, heads, blocks = false, children }: Props) {
  const { t } = useTranslation();
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard scrolls it
    <section className={blocks ? "scroll blocks" : "scroll"} aria-label={t(label)} tabIndex={0}>
      <table>
        <thead>
          <tr>
            {heads.map((head) => (
              <th key={head} scope="col">
                {t(head)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody id={id}>{children}</tbody>
      </table>
    </section>
  );
}
