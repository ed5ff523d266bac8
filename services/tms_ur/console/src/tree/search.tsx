// Searches nodes of a tree by their type, name, ports and path.
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { matching, type TreeNode } from "./shape";

interface Props {
  nodes: Map<string, TreeNode>;
  onFound: (found: TreeNode[]) => void;
  onGo: (node: TreeNode) => void; // shows one of them
}

export function Search({ nodes, onFound, onGo }: Props) {
  const { t } = useTranslation();
  const [words, setWords] = useState("");
  const [at, setAt] = useState(-1);
  const found = useMemo(() => matching(nodes, words), [nodes, words]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the listener is another one with each drawing
  useEffect(() => onFound(found), [found]);
  const go = (step: number) => {
    const next = (at + step + found.length) % Math.max(1, found.length);
    const node = found[next];
    setAt(next);
    if (node !== undefined) {
      onGo(node);
    }
  };
  return (
    <search className="bar">
      <label>
        {t("search")}{" "}
        <input
          type="search"
          value={words}
          onChange={(event) => {
            setWords(event.target.value);
            setAt(-1);
          }}
          onKeyDown={(event) => event.key === "Enter" && go(event.shiftKey ? -1 : 1)}
        />
      </label>
      {words.trim() !== "" && (
        <>
          <span role="status">{t("found_of", { at: at + 1, count: found.length })}</span>
          <button type="button" disabled={found.length === 0} onClick={() => go(1)}>
            {t("next")}
          </button>
        </>
      )}
    </search>
  );
}
