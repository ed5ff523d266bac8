// The site in 3D; loaded when somebody wants to see it.

import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Ground } from "../../models";
import type { Scene } from "../picture";
import type { View } from "../view";
import { Stage } from "./stage";

interface Props {
  scene: Scene;
  view: View; // of the map: there it begins
  follow: string;
  ground: Ground | null; // null: not known yet
  design: boolean;
}

export default function Space({ scene, view, follow, ground, design }: Props) {
  const { t } = useTranslation();
  const canvas = useRef<HTMLCanvasElement>(null);
  const names = useRef<HTMLDivElement>(null);
  const first = useRef(view);
  const [stage, setStage] = useState<Stage | "none" | null>(null);
  useEffect(() => {
    const made = begin(canvas.current, names.current, first.current);
    setStage(made ?? "none");
    return () => made?.end();
  }, []);
  const there = stage === "none" ? null : stage;
  useEffect(() => there?.tell(scene, follow), [there, scene, follow]);
  useEffect(() => {
    const element = canvas.current?.parentElement;
    if (!there || !element) {
      return;
    }
    const sized = new ResizeObserver(() => there.resize(element.clientWidth, element.clientHeight));
    sized.observe(element);
    return () => sized.disconnect();
  }, [there]);
  useEffect(() => {
    if (ground !== null) {
      there?.setGround(ground);
    }
  }, [there, ground]);
  useEffect(() => {
    if (ground !== null) {
      there?.showDesign(design); // also of a new ground
    }
  }, [there, ground, design]);
  return (
    <>
      <canvas ref={canvas} id="space" role="img" aria-label={t("map_3d_label")} />
      <div ref={names} className="names" aria-hidden="true" />
      {stage === "none" && <p className="bad">{t("no_3d")}</p>}
    </>
  );
}

function begin(canvas: HTMLCanvasElement | null, names: HTMLElement | null, view: View): Stage | null {
  try {
    return canvas && names && new Stage(canvas, names, view);
  } catch {
    return null; // the browser has no WebGL
  }
}
