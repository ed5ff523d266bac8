// Pointer, wheel, pinch and keys on a picture. Not React's events: its wheel cannot keep the page from scrolling.

type Pixel = readonly [number, number]; // of the picture

/** What they ask for, in pixels of the picture. */
export interface Asked {
  move: (dx: number, dy: number) => void;
  zoom: (factor: number, px?: number, py?: number) => void;
  tap: (px: number, py: number) => void;
}

const STEP = 60; // px that an arrow key moves
export const ZOOM = 1.25; // of a key or a button
const TAP = 5; // px within which a press is a click and no drag
const WHEEL = 500; // px of a wheel that make it e times as large
const MOVES: Record<string, Pixel> = {
  ArrowLeft: [STEP, 0],
  ArrowRight: [-STEP, 0],
  ArrowUp: [0, STEP],
  ArrowDown: [0, -STEP],
};
const ZOOMS: Record<string, number> = { "+": ZOOM, "=": ZOOM, "-": 1 / ZOOM };

export class Hands {
  private readonly fingers = new Map<number, Pixel>();
  private travel = 0; // px since all fingers were up
  private readonly leave = new AbortController();

  constructor(
    private readonly element: HTMLElement,
    private readonly asked: () => Asked,
  ) {
    const { signal } = this.leave;
    element.addEventListener("pointerdown", this.down, { signal });
    element.addEventListener("pointermove", this.drag, { signal });
    element.addEventListener("pointerup", this.up, { signal });
    element.addEventListener("pointercancel", this.up, { signal });
    element.addEventListener("click", this.click, { signal });
    element.addEventListener("wheel", this.wheel, { signal, passive: false });
    element.addEventListener("keydown", this.key, { signal });
  }

  readonly end = () => this.leave.abort();

  private local(event: MouseEvent): Pixel {
    const frame = this.element.getBoundingClientRect();
    return [event.clientX - frame.left, event.clientY - frame.top];
  }

  private readonly down = (event: PointerEvent) => {
    this.travel = this.fingers.size === 0 ? 0 : this.travel;
    this.fingers.set(event.pointerId, this.local(event));
  };

  private readonly up = (event: PointerEvent) => {
    this.fingers.delete(event.pointerId);
  };

  private readonly drag = (event: PointerEvent) => {
    const before = this.fingers.get(event.pointerId);
    if (before === undefined) {
      return;
    }
    const here = this.local(event);
    const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
    this.fingers.set(event.pointerId, here);
    this.travel += apart(here, before);
    if (other !== undefined) {
      const factor = apart(here, other) / (apart(before, other) || 1);
      this.asked().zoom(factor || 1, (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
    } else if (this.travel > TAP) {
      if (!this.element.hasPointerCapture(event.pointerId)) {
        this.element.setPointerCapture(event.pointerId); // not before: a captured click reaches nothing inside
      }
      this.asked().move(here[0] - before[0], here[1] - before[1]);
    }
  };

  private readonly click = (event: MouseEvent) => {
    if (this.travel <= TAP) {
      this.asked().tap(...this.local(event));
    }
  };

  private readonly wheel = (event: WheelEvent) => {
    event.preventDefault();
    this.asked().zoom(Math.exp(-event.deltaY / WHEEL), ...this.local(event));
  };

  private readonly key = (event: KeyboardEvent) => {
    const [by, factor] = [MOVES[event.key], ZOOMS[event.key]];
    if (event.target !== this.element || (!by && !factor)) {
      return;
    }
    event.preventDefault();
    if (by) {
      this.asked().move(...by);
    } else if (factor) {
      this.asked().zoom(factor);
    }
  };
}

const apart = (one: Pixel, other: Pixel) => Math.hypot(one[0] - other[0], one[1] - other[1]);
