// What a check has found, those of a kind together.
import { useTranslation } from "react-i18next";
import { groupsOf } from "./finding_groups";
import type { Checked, Finding } from "./models";
import { Said } from "./said";

const SHOWN = 3; // of a kind; more are folded

interface Props {
  found: Checked;
  onLine?: (line: number) => void; // goes to a line of the text that is on the screen
}

export function Findings({ found, ...rest }: Props) {
  const { t } = useTranslation();
  if (found.errors.length + found.warnings.length === 0) {
    return <p className="good">{t("check_good")}</p>;
  }
  return (
    <>
      <Kind kind="errors" found={found.errors} {...rest} />
      <Kind kind="warnings" found={found.warnings} {...rest} />
    </>
  );
}

interface ListProps {
  found: Finding[];
  onLine?: (line: number) => void;
}

function Kind({ kind, found, ...rest }: ListProps & { kind: "errors" | "warnings" }) {
  const { t } = useTranslation();
  if (found.length === 0) {
    return null;
  }
  return (
    <>
      <h3>
        {t(kind)} ({found.length})
      </h3>
      <ul className={kind}>
        {groupsOf(found).map((group, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: the list is made anew as a whole
          <Group key={index} found={group} {...rest} />
        ))}
      </ul>
    </>
  );
}

function Group({ found, ...rest }: ListProps) {
  const { t } = useTranslation();
  const more = found.slice(SHOWN);
  return (
    <>
      <Items found={found.slice(0, SHOWN)} {...rest} />
      {more.length > 0 && (
        <li>
          <details>
            <summary>{t("more_of_kind", { count: more.length })}</summary>
            <ul>
              <Items found={more} {...rest} />
            </ul>
          </details>
        </li>
      )}
    </>
  );
}

function Items({ found, onLine }: ListProps) {
  return found.map((one, index) => (
    // biome-ignore lint/suspicious/noArrayIndexKey: the list is made anew as a whole
    <li key={index} data-line={one.line ?? ""}>
      <Said reason={one.reason} done={onLine && "edit_task"} />
      {onLine && one.line !== null && <ToLine line={one.line} onLine={onLine} />}
    </li>
  ));
}

function ToLine({ line, onLine }: { line: number; onLine: (line: number) => void }) {
  const { t } = useTranslation();
  return (
    <button type="button" onClick={() => onLine(line)}>
      {t("line", { line })}
    </button>
  );
}
