// What can be put into the tree: click to add, or drag.
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Where } from "./acts";
import { SOURCE } from "./edit_box";
import type { Entry, Group } from "./palette";

const PLACES: Where[] = ["inside", "before", "after", "around"];

interface Props {
  groups: Group[];
  where: Where;
  onWhere: (where: Where) => void;
  onAdd: (source: string) => void;
}

export function PaletteList({ groups, where, onWhere, onAdd }: Props) {
  const { t } = useTranslation();
  const [words, setWords] = useState("");
  const fits = (entry: Entry) => entry.label.toLowerCase().includes(words.toLowerCase());
  const shown = groups
    .map((group) => ({ ...group, entries: group.entries.filter(fits) }))
    .filter((group) => group.entries.length > 0);
  return (
    <section className="ed_palette" aria-label={t("ed_palette")}>
      <label>
        {t("ed_where")}
        <select value={where} onChange={(event) => onWhere(event.target.value as Where)}>
          {PLACES.map((one) => (
            <option key={one} value={one}>
              {t(`ed_${one}`)}
            </option>
          ))}
        </select>
      </label>
      <label>
        {t("filter")}
        <input type="search" value={words} onChange={(event) => setWords(event.target.value)} />
      </label>
      {groups.length === 0 && <p>{t("scheduler_silent")}</p>}
      {shown.map((group, index) => (
        <details key={group.title} open={words !== "" || index === 0}>
          <summary>{group.machine ? group.title : t(group.title)}</summary>
          {group.entries.map((entry) => (
            <button
              key={entry.label}
              type="button"
              title={entry.help}
              draggable
              onDragStart={(event) => event.dataTransfer.setData(SOURCE, entry.source)}
              onClick={() => onAdd(entry.source)}
            >
              {entry.label}
            </button>
          ))}
        </details>
      ))}
    </section>
  );
}
