// How two trees differ, line by line.
import { useTranslation } from "react-i18next";

/** `text`: a unified diff, empty if they are equal. */
export function Difference({ id, text }: { id: string; text: string }) {
  const { t } = useTranslation();
  const mark = (line: string) => (line.startsWith("+") ? "added" : line.startsWith("-") ? "removed" : "");
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: the keyboard scrolls it
    <pre id={id} tabIndex={0}>
      {text === ""
        ? t("equal")
        : text.split("\n").map((line, index) => (
            // biome-ignore lint/suspicious/noArrayIndexKey: the list is made anew as a whole
            <span key={index} className={mark(line)}>
              {`${line}\n`}
            </span>
          ))}
    </pre>
  );
}
