"""From the change of a field in the editor to the finding at its node, painted: a task of 300 nodes in a real mesh."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from bench.runner import Figure

if TYPE_CHECKING:
    from pathlib import Path

    from conftest import Mesh

BRANCHES, LEAVES = 13, 22  # 300 nodes
ROUNDS = 10
LIMIT = 300.0  # ms
USUAL = 20.0  # ms, of an answer
RIGHT, WRONG = "release_angle", "release_angel"
LEAF = f"""<LeafNodeZx200 model_name="zx200" subtask_name="subtask_zx200_release_simple" record_name="{RIGHT}"/>"""
# Gives the times of some rounds [ms].
FOUND = """async ([rounds, right, wrong]) => {
  const frame = () => new Promise(requestAnimationFrame), times = [];
  const label = [...document.querySelectorAll("#ed_form label")].find((one) => one.textContent === "record_name");
  const input = document.getElementById(label.htmlFor);
  const set = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set;
  const marked = () => document.querySelector("[data-path='0.6.11'] .node_mark").textContent.trim() !== "";
  for (let i = 0; i < rounds; i += 1) {
    set.call(input, i % 2 ? right : wrong);
    input.dispatchEvent(new Event("input", { bubbles: true }));
    await frame();
    const begun = performance.now();
    input.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
    while (marked() !== (i % 2 === 0)) {
      await frame();
      if (performance.now() - begun > 30_000) {
        throw new Error("the findings do not come");
      }
    }
    times.push(performance.now() - begun);
  }
  return times;
}"""


def task() -> str:
    """300 nodes, a line each."""
    lines = "\n".join([LEAF] * LEAVES)
    branch = f"<Sequence>\n{lines}\n</Sequence>\n"
    tree = f'<BehaviorTree ID="M"><Sequence>{branch * BRANCHES}</Sequence></BehaviorTree>'
    return f'<root main_tree_to_execute="M">{tree}</root>'


def findings(mesh: Mesh, folder: Path, address: str, ping: str) -> Figure:
    """The largest but one of some rounds; `ping`: a script that gives the floor [ms], an answer of the same server."""
    from browsers import chromium

    file = folder / "drawing.xml"
    file.write_text(task())
    number = json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"]
    with chromium() as browser:
        page = browser.new_page(locale="en-GB", viewport={"width": 1280, "height": 800})
        page.goto(f"{address}/#editor/{number}")
        page.locator("[data-path='0.6.11']").click()  # below the root, which the picture shows
        page.get_by_label("record_name", exact=True).wait_for()
        found = page.evaluate(FOUND, [ROUNDS, RIGHT, WRONG])
        floor = page.evaluate(ping, ROUNDS)
    return Figure("findings at 300 nodes", "ms", sorted(found)[-2], LIMIT, floor, usual_floor=USUAL)
