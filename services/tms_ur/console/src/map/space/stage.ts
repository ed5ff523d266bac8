// The scene in 3D: it is drawn when something has changed, and while machines move. Libraries that drive three by React
// are not used: what changes is a few numbers ten times a second, and each would be one more reconciler on the page.

import {
  Color,
  ColorManagement,
  Group,
  LinearSRGBColorSpace,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Ground } from "../../models";
import type { Scene as Told } from "../picture";
import type { View } from "../view";
import { Fleet } from "./fleet";
import { Labels } from "./labels";
import { disposed, laid, people } from "./lines";
import { Terrain } from "./terrain";

ColorManagement.enabled = false; // colours as they are told: no power for each pixel

const SKY = 0xcfe0ee;
const ANGLE = 50; // deg, of the view, upwards
const FAR = 3000; // m
const LAYS = 1000; // ms between two layings of paths, which grow
const LONGEST = 0.2; // s between pictures, after which machines do not move on

export class Stage {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(ANGLE, 1, 0.5, FAR);
  private readonly controls: OrbitControls;
  private readonly labels: Labels;
  private fleet: Fleet | null = null;
  private terrain: Terrain | null = null;
  private things = new Group();
  private people = new Group();
  private lain = Number.NEGATIVE_INFINITY; // ms, when paths were laid last
  private told: Told | null = null;
  private follow = "";
  private followed: Vector3 | null = null;
  private frame = 0; // of the browser; 0: none is asked for
  private before = 0; // ms, when the last picture was drawn
  private pictures = 0;

  /** Throws where the browser shows no 3D. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    names: HTMLElement,
    view: View,
  ) {
    // without alpha, the page need not mix the picture with what is behind it
    const context = canvas.getContext("webgl2", { alpha: false, antialias: false, stencil: false }) ?? undefined;
    this.renderer = new WebGLRenderer({ canvas, antialias: false, ...(context && { context }) });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.scene.background = new Color(SKY);
    this.scene.add(this.things, this.people);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.03; // not below the ground
    this.controls.addEventListener("change", this.ask);
    const away = Math.max(15, 500 / view.scale);
    this.controls.target.set(view.x, view.y, 0);
    this.camera.position.set(view.x - away * 0.35, view.y - away, away * 0.7);
    this.controls.update();
    this.labels = new Labels(names);
  }

  private readonly height = (x: number, y: number) => this.terrain?.field.near(x, y) ?? 0;

  /** Takes the state of the site. */
  tell(told: Told, follow: string) {
    this.told = told;
    this.followed = follow === this.follow ? this.followed : null;
    this.follow = follow;
    if (this.fleet === null) {
      this.fleet = new Fleet(told.bodies.values()); // which do not change
      this.scene.add(this.fleet.mesh);
    }
    for (const machine of told.state.machines) {
      this.fleet.models.get(machine.name)?.tell(machine);
    }
    this.people = this.instead(this.people, people(told, this.height));
    if (performance.now() - this.lain > LAYS) {
      this.lay();
    }
    this.ask();
  }

  /** Takes the ground; without rows there is none. */
  setGround(ground: Ground) {
    this.terrain?.dispose();
    if (this.terrain !== null) {
      this.scene.remove(this.terrain.group);
    }
    const first = this.terrain === null;
    this.terrain = (ground.rows ?? 0) > 0 ? new Terrain(ground) : null;
    if (this.terrain !== null) {
      this.scene.add(this.terrain.group);
      if (first) {
        const up = this.height(this.controls.target.x, this.controls.target.y);
        this.controls.target.z += up;
        this.camera.position.z += up;
        this.controls.update();
      }
    }
    this.lay();
    this.ask();
  }

  showDesign(shown: boolean) {
    this.terrain?.showDesign(shown);
    this.ask();
  }

  resize(width: number, height: number) {
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.ask();
  }

  end() {
    cancelAnimationFrame(this.frame);
    this.frame = -1;
    this.controls.dispose();
    this.terrain?.dispose();
    this.fleet?.dispose();
    disposed(this.things);
    disposed(this.people);
    this.renderer.dispose();
  }

  private lay() {
    if (this.told !== null) {
      this.lain = performance.now();
      this.things = this.instead(this.things, laid(this.told, this.height));
    }
  }

  private instead(old: Group, now: Group): Group {
    this.scene.remove(old);
    disposed(old);
    this.scene.add(now);
    return now;
  }

  private readonly ask = () => {
    if (this.frame === 0) {
      this.frame = requestAnimationFrame(this.draw);
    }
  };

  private readonly draw = (now: number) => {
    this.frame = 0;
    const seconds = Math.min(LONGEST, (now - this.before) / 1000);
    this.before = now;
    let moves = false;
    for (const model of this.fleet?.models.values() ?? []) {
      moves = model.move(seconds, this.height) || moves;
    }
    this.goAlong();
    this.terrain?.look(this.camera.position);
    this.renderer.render(this.scene, this.camera);
    if (this.fleet !== null) {
      this.labels.place(this.fleet.models, this.camera, this.canvas, this.height);
    }
    this.pictures += 1;
    this.canvas.dataset.pictures = String(this.pictures); // what `make bench` counts
    if (this.terrain !== null) {
      this.canvas.dataset.triangles = String(this.terrain.triangles);
    }
    if (moves) {
      this.ask();
    }
  };

  /** The eye goes with the machine that is followed. */
  private goAlong() {
    const shown = this.fleet?.models.get(this.follow)?.shown;
    if (!shown) {
      return;
    }
    const here = new Vector3(shown.x, shown.y, this.height(shown.x, shown.y));
    const way = here.clone().sub(this.followed ?? this.controls.target);
    this.followed = here;
    if (way.lengthSq() > 0) {
      this.controls.target.add(way);
      this.camera.position.add(way);
      this.controls.update();
    }
  }
}
