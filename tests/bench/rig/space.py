"""How long a picture of the site in 3D takes, in a Chromium without graphics hardware."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bench.rig.big_site import big_site
from bench.runner import Figure

if TYPE_CHECKING:
    from playwright.sync_api import Page

WIDTH, HEIGHT = 1280, 720  # px of the picture
SECONDS = 10
TRIANGLES = 60_000  # of the ground at most
LIMIT = 50.0  # ms a picture: 20 a second
USUAL = 17.0  # ms, of a picture that is only wiped
# Both count pictures for so many seconds and give milliseconds a picture.
DRAWN = """async (seconds) => {
  const canvas = document.getElementById("space"), begun = performance.now(), before = Number(canvas.dataset.pictures);
  await new Promise((over) => setTimeout(over, seconds * 1000));
  return (performance.now() - begun) / (Number(canvas.dataset.pictures) - before);
}"""
WIPED = """async ([width, height, seconds]) => {
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  document.body.replaceChildren(canvas);
  const gl = canvas.getContext("webgl2"), begun = performance.now();
  let pictures = 0;
  while (performance.now() - begun < seconds * 1000) {
    await new Promise(requestAnimationFrame);
    gl.clearColor(pictures % 2, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    pictures += 1;
  }
  return (performance.now() - begun) / pictures;
}"""


def space(folder: Path) -> Figure:
    """Twenty machines that move on hills; the floor is a picture of that size without anything."""
    from browsers import chromium

    with big_site(folder) as address, chromium() as browser:
        page = browser.new_page(locale="en-GB", viewport={"width": WIDTH + 64, "height": round(HEIGHT / 0.62) + 8})
        page.goto(f"{address}/#map/3d")
        return _measured(page)


def _measured(page: Page) -> Figure:
    page.wait_for_selector("#space[data-triangles]")
    width, height, triangles = page.evaluate(
        "(({ width, height, dataset }) => [width, height, Number(dataset.triangles)])(document.getElementById('space'))"
    )
    assert width >= WIDTH and height >= HEIGHT and triangles <= TRIANGLES, (width, height, triangles)
    drawn = page.evaluate(DRAWN, SECONDS)
    floor = page.evaluate(WIPED, [width, height, SECONDS / 2])
    return Figure(
        "picture in 3D, 20 machines", "ms", drawn, LIMIT, floor, usual_floor=USUAL, note=f"{triangles} triangles"
    )
