// How often a node was tried, how long each try took, and what came of it.
import { duration } from "old/dom.js";
import { useTranslation } from "react-i18next";
import { type Attempt, attemptsOf } from "../journal/attempts";
import type { Journal } from "../journal/journal";
import { Said } from "../said";
import { clock } from "../texts";
import { WORDS } from "./node_box";
import type { TreeNode } from "./shape";

const SHOWN = 10; // the newest

interface Props {
  journal: Journal;
  count: number; // of its events, up to the moment that is shown
  now: number; // ms since the epoch: that moment
  node: TreeNode;
}

export function Attempts({ journal, count, now, node }: Props) {
  const { t } = useTranslation();
  const attempts = attemptsOf(journal, count).filter((one) => one.index === node.index);
  return (
    <>
      <h4>
        {t("attempts")} ({attempts.length})
      </h4>
      <ul className="plain" id="node_attempts">
        {attempts
          .slice(-SHOWN)
          .reverse()
          .map((one) => (
            <Try key={one.event} attempt={one} now={now} journal={journal} />
          ))}
      </ul>
    </>
  );
}

function Try({ attempt, now, journal }: { attempt: Attempt; now: number; journal: Journal }) {
  const { t } = useTranslation();
  const { begin, end, state } = attempt;
  const word = state === "idle" ? "halted" : WORDS[state];
  const reason = state === "failure" ? journal.events[attempt.event]?.reason : null;
  return (
    <li>
      {clock(new Date(begin).toISOString())} {duration(Math.max(0, (end ?? now) - begin) / 1000)} {t(word)}
      {reason && (
        <div>
          <Said reason={reason} />
        </div>
      )}
    </li>
  );
}
