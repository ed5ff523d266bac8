// The pages and the links to them: those that are React, and those that are still plain modules.

import { relabelAll, say } from "old/dom.js";
import { translatePage } from "old/strings.js";
import { PAGE_NAMES } from "old/words.js";
import { type ComponentType, lazy, Suspense, useEffect, useRef, useSyncExternalStore } from "react";
import { useTranslation } from "react-i18next";
import { Board } from "./board/board";
import { current, listsChanged, subscribe } from "./live";
import type { State } from "./models";
import { texts } from "./texts";

// The board comes with the frame, others when they are opened.
const REACT: Record<string, ComponentType<{ rest: string }>> = {
  board: Board,
  history: lazy(() => import("./history/history_page")),
  map: lazy(() => import("./map/map_page")),
  tasks: lazy(() => import("./tasks/tasks_page")),
  tree: lazy(() => import("./tree/tree_page")),
};

const hash = () => location.hash.slice(1);
function onHash(listener: () => void) {
  addEventListener("hashchange", listener);
  return () => removeEventListener("hashchange", listener);
}

export function Pages() {
  const { t } = useTranslation();
  const address = useSyncExternalStore(onHash, hash);
  const [asked = "", ...rest] = address.split("/");
  const name = PAGE_NAMES.includes(asked) ? asked : "board";
  const New = REACT[name];
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
        {New === undefined ? (
          <OldPage key={name} name={name} rest={rest.join("/")} />
        ) : (
          <div id="page" data-page={name}>
            <Suspense>
              <New rest={rest.join("/")} />
            </Suspense>
          </div>
        )}
      </main>
    </>
  );
}

/** A plain module: build(root), update(state), and where it needs them load(), open(rest) and redraw(). */
interface Module {
  build(root: HTMLElement): void;
  update(state: State): void;
  load?(): void;
  open?(rest: string[]): void;
  redraw?(): void;
}

function OldPage({ name, rest }: { name: string; rest: string }) {
  const root = useRef<HTMLDivElement>(null);
  const page = useRef<Module | null>(null);
  const wanted = useRef(rest);
  wanted.current = rest;
  useEffect(() => {
    let left = false;
    let end = () => {};
    import(/* @vite-ignore */ `/pages/${name}.js`).then((module: Module) => {
      if (!left && root.current !== null) {
        page.current = module;
        end = show(module, root.current, wanted.current);
      }
    });
    return () => {
      left = true;
      end();
    };
  }, [name]);
  useEffect(() => {
    if (page.current !== null) {
      open(page.current, rest);
    }
  }, [rest]);
  return <div id="page" data-page={name} ref={root} />;
}

/** Gives a page what stands behind its name in the address. */
function open(module: Module, rest: string) {
  module.open?.(rest === "" ? [] : rest.split("/").map(decodeURIComponent));
  module.load?.();
  fill(module, current().state);
}

function fill(module: Module, state: State | null) {
  if (state !== null) {
    module.update(state);
  }
}

/** Builds the page and keeps it filled; returns what ends that. */
function show(module: Module, root: HTMLElement, rest: string): () => void {
  module.build(root);
  translatePage();
  open(module, rest);
  const end = subscribe((now, before) => {
    fill(module, now.state);
    if (listsChanged(now, before)) {
      module.load?.();
    }
  });
  const translated = () => {
    relabelAll();
    module.redraw?.();
    fill(module, current().state);
    module.load?.();
  };
  texts.on("languageChanged", translated);
  return () => {
    texts.off("languageChanged", translated);
    end();
  };
}
