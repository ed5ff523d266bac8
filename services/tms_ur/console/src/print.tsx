// What a print has that the screen has not: the page's title with the time, and pictures as wide as the paper.
import "./print.css";
import { siteNow } from "old/server.js";
import { useEffect, useState } from "react";
import { flushSync } from "react-dom";
import { useTranslation } from "react-i18next";
import { dateTime } from "./texts";

const PAPER = 680; // px: A4 upright without its margins, of which printers differ
const PICTURES = ".plot, .mapbox, .treebox.flow";

/** Pictures keep the size for which they were drawn, and are shown as much smaller as the paper is. */
function measure() {
  document.documentElement.dataset.drawn = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  for (const picture of document.querySelectorAll<HTMLElement>(PICTURES)) {
    const { width, height } = picture.getBoundingClientRect();
    if (width > 0) {
      picture.style.setProperty("--screen-width", `${width}px`);
      picture.style.setProperty("--screen-height", `${height}px`);
      picture.style.setProperty("--paper-zoom", String(Math.min(1, PAPER / width)));
    }
  }
}

export function PaperHead({ name }: { name: string }) {
  const { t } = useTranslation();
  const [now, setNow] = useState(siteNow());
  useEffect(() => {
    const print = () => {
      measure();
      flushSync(() => setNow(siteNow())); // the browser takes the page as it is when this returns
    };
    addEventListener("beforeprint", print);
    return () => removeEventListener("beforeprint", print);
  }, []);
  return (
    <p id="paper_head" className="paper">
      {[t(`p_${name}`, { defaultValue: "" }), dateTime(new Date(now).toISOString())].filter(Boolean).join(", ")}
    </p>
  );
}
