"""How smoothly a tree of 1,000 nodes moves under the pointer while its run goes on; a made-up site, no ROS."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from bench.rig.feeding import fed
from bench.runner import Figure
from browser.yard import RUN, Yard, shape
from tms_ur.models import Event
from unit.tms_ur.fakes import NOON

if TYPE_CHECKING:
    from playwright.sync_api import Page

BRANCHES, LEAVES = 37, 26  # 1,000 nodes
PERIOD = 0.5  # s that a leaf works
FRAMES = 200
LIMIT = 1000 / 30  # ms a frame
USUAL = 17.0  # ms, of a page with one box that moves
# Both move something by hand with every frame, and give the mean time of one [ms].
PANNED = """async (frames) => {
  const pane = document.querySelector("#tree_box .react-flow__pane"), box = pane.getBoundingClientRect();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const press = (target, type, x) => target.dispatchEvent(new MouseEvent(type,
    { bubbles: true, cancelable: true, view: window, clientX: x, clientY: middle[1], button: 0, buttons: 1 }));
  const frame = () => new Promise(requestAnimationFrame);
  press(pane, "mousedown", middle[0]);
  const begun = (await frame(), performance.now()), places = new Set();
  for (let i = 0; i < frames; i += 1) {
    press(window, "mousemove", middle[0] + 400 * Math.sin(i / 15));
    await frame();
    places.add(document.querySelector("#tree_box .react-flow__viewport").style.transform);
  }
  press(window, "mouseup", middle[0]);
  return [(performance.now() - begun) / frames, places.size];
}"""
MOVED = """async (frames) => {
  const box = document.createElement("div");
  box.style.cssText = "width: 200px; height: 64px; background: orange; position: absolute";
  document.body.replaceChildren(box);
  const begun = performance.now();
  for (let i = 0; i < frames; i += 1) {
    box.style.transform = `translate(${400 + 400 * Math.sin(i / 15)}px, 200px)`;
    await new Promise(requestAnimationFrame);
  }
  return (performance.now() - begun) / frames;
}"""


def trees(folder: Path) -> Iterator[Figure]:
    """At a zoom that can be read, with all branches open; and the whole tree at once."""
    from browsers import chromium

    with _running(folder) as address, chromium() as browser:
        page = browser.new_page(locale="en-GB", viewport={"width": 1280, "height": 800})
        page.goto(f"{address}/#tree")
        page.wait_for_selector("#tree_box [data-path]")
        page.get_by_role("button", name="Open all").click()
        legible = _panned(page)
        page.get_by_role("button", name="Fit").click()
        page.wait_for_timeout(500)  # ms: it moves there
        count = page.locator("#tree_box [data-path]").count()
        whole = _panned(page)
        floor = page.evaluate(MOVED, FRAMES)
    yield _figure("frame of a tree, 1,000 nodes", legible, floor, "")
    yield _figure("frame of a tree, all in sight", whole, floor, f"{count} nodes are drawn")


def _panned(page: Page) -> float:
    time, places = page.evaluate(PANNED, FRAMES)
    assert places > FRAMES / 2, f"it has moved {places} times"
    return float(time)


def _figure(name: str, value: float, floor: float, note: str) -> Figure:
    return Figure(name, "ms", value, LIMIT, floor, usual_floor=USUAL, note=note)


@contextmanager
def _running(folder: Path) -> Iterator[str]:
    """A console whose run works on leaf after leaf; gives the address."""
    yard, tree = Yard(), shape(BRANCHES, LEAVES)
    yard.receive()
    yard.journals = {"r-1": [Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**tree})]}
    leaves = [path for path in tree["paths"] if path.count(".") == 2]

    def work(leaf: str) -> None:
        at = tree["paths"].index(leaf)
        on = {"0", leaf, leaf.rpartition(".")[0]}
        states = ("1" if path in on else "2" if i < at else "0" for i, path in enumerate(tree["paths"]))
        yard.board.put_runs([RUN.model_copy(update={"leaf": leaf, "nodes": "".join(states)})])

    def feed(leave: threading.Event) -> None:
        for leaf in leaves[len(leaves) // 2 :]:
            work(leaf)
            if leave.wait(PERIOD):
                return

    work(leaves[len(leaves) // 2])
    with fed(yard, folder, feed) as address:
        yield address
