// Draws tasks and templates: `#editor/new`, `#editor/NUMBER`, `#editor/template/NAME`. With `/difference/NUMBER` behind it
// the difference to that task is open.
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Problem } from "../problem";
import { Editor } from "./editor";
import { readRecords, readSite, readTarget, type Site, type Target } from "./site";
import { parse, XmlError } from "./xml";

interface Loaded {
  rest: string;
  site: Site;
  target: Target;
}

/** The line at which the text is no XML, null: it is. */
function broken(text: string): number | null {
  try {
    parse(text);
    return null;
  } catch (error) {
    if (error instanceof XmlError) {
      return error.line;
    }
    throw error;
  }
}

export default function EditorPage({ rest: address }: { rest: string }) {
  const { t } = useTranslation();
  const [rest = "", other = ""] = address.split("/difference/");
  const [loaded, setLoaded] = useState<Loaded | null>(null);
  const [error, setError] = useState<Error | null>(null);
  useEffect(() => {
    let left = false;
    setError(null);
    Promise.all([readSite(), readTarget(rest)]).then(
      ([site, target]) => left || setLoaded({ rest, site, target }),
      (why: Error) => left || setError(why),
    );
    return () => {
      left = true;
    };
  }, [rest]);
  const withRecords = async () => {
    try {
      const records = await readRecords();
      setLoaded((now) => now && { ...now, site: { ...now.site, records } });
    } catch (why) {
      setError(why as Error);
    }
  };
  const shown = loaded?.rest === rest ? loaded : null;
  const line = shown && broken(shown.target.text);
  const kind = shown?.target.kind ?? "new";
  return (
    <>
      <h2>{t(`ed_title_${kind}`, { name: shown?.target.name ?? "" })}</h2>
      <p>
        <a href="#tasks">{t("tasks")}</a>
      </p>
      <Problem error={error} />
      {line !== null && <p className="bad">{t("ed_broken", { line })}</p>}
      {shown && line === null && <Editor key={address} {...shown} other={other} onRecord={withRecords} />}
    </>
  );
}
