// A table that scrolls in a region of its own.
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";

interface Props {
  id: string; // of its body
  label: string; // key of its name, which distinguishes it from other tables of the page
  heads: string[]; // keys
  children: ReactNode; // rows
}

export function Table({ id, label, heads, children }: Props) {
  const { t } = useTranslation();
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard scrolls it
    <section className="scroll" aria-label={t(label)} tabIndex={0}>
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
