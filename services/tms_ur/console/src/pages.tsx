// The pages and the links to them.

import { say } from "old/dom.js";
import { PAGE_NAMES } from "old/words.js";
import { type ComponentType, lazy, Suspense, useEffect, useSyncExternalStore } from "react";
import { useTranslation } from "react-i18next";
import { Board } from "./board/board";
import { Fault } from "./fault";
import { PaperHead } from "./print";

type Page = ComponentType<{ rest: string }>; // `rest`: what stands behind its name in the address

// A page is NAME/NAME_page.tsx. The board comes with the frame, others when they are opened.
const FILES = import.meta.glob<{ default: Page }>("./*/*_page.tsx");
const PAGES = new Map<string, Page>([
  ["board", Board],
  ...Object.entries(FILES).map(([path, load]): [string, Page] => [path.split("/")[1] ?? "", lazy(load)]),
]);

const hash = () => location.hash.slice(1);
function onHash(listener: () => void) {
  addEventListener("hashchange", listener);
  return () => removeEventListener("hashchange", listener);
}

export function Pages() {
  const { t } = useTranslation();
  const address = useSyncExternalStore(onHash, hash);
  const [asked = "", ...rest] = address.split("/");
  const name = PAGES.has(asked) ? asked : "board";
  const Chosen = PAGES.get(name) ?? Board;
  // biome-ignore lint/correctness/useExhaustiveDependencies: the message belongs to the page that is left
  useEffect(() => () => say(""), [name]);
  return (
    <>
      <nav id="pages" aria-label={t("pages")}>
        {PAGE_NAMES.map((one) => (
          <a key={one} href={`#${one}`} aria-current={one === name ? "page" : "false"}>
            {t(`p_${one}`)}
          </a>
        ))}
      </nav>
      <main id="main" tabIndex={-1}>
        <PaperHead name={name} />
        <div id="page" data-page={name}>
          <Fault key={name}>
            <Suspense>
              <Chosen rest={rest.join("/")} />
            </Suspense>
          </Fault>
        </div>
      </main>
    </>
  );
}
