"""From the change of a field in the editor to the finding at its node, painted: a task of 300 nodes; no ROS."""

from __future__ import annotations

from pathlib import Path

from bench.runner import Figure
from browser.yard import Yard, serving
from tms_reason.reason import Reason
from tms_ts.bt import check, palette
from tms_ur.models import TaskText
from unit.tms_ur.fakes import NOON, WrongLine

BRANCHES, LEAVES = 13, 22  # 300 nodes
ROUNDS = 10
LIMIT = 300.0  # ms
USUAL = 60.0  # ms, of a check that the server answers
RIGHT, WRONG = "release_angle", "release_angel"
LEAF = f"""<LeafNodeZx200 model_name="zx200" subtask_name="subtask_zx200_release_simple" record_name="{RIGHT}"/>"""
# Both give the times of some rounds [ms].
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
CHECKED = """async ([rounds, xml]) => {
  const times = [];
  for (let i = 0; i < rounds; i += 1) {
    const begun = performance.now();
    await (await fetch("/api/tasks/check", { method: "POST", headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ xml }) })).json();
    times.push(performance.now() - begun);
  }
  return times;
}"""


class Drawing(Yard):
    """A site whose task has 300 nodes, a line each; its check reads the tree, and finds the wrong record."""

    def __init__(self) -> None:
        super().__init__()
        self.palette = palette(builtin=True)
        lines = "\n".join([LEAF] * LEAVES)
        branch = f"<Sequence>\n{lines}\n</Sequence>\n"
        tree = f'<BehaviorTree ID="M"><Sequence>{branch * BRANCHES}</Sequence></BehaviorTree>'
        self.xml = f'<root main_tree_to_execute="M">{tree}</root>'

    def task(self, task_id: int) -> TaskText:
        return TaskText(id=task_id, model_name="zx200", description="", added_at=NOON, xml=self.xml)

    def check_task(self, xml: str) -> tuple[list[Reason], list[Reason]]:
        found: list[Reason] = [error.reason for error in check(xml).errors]
        wrong = (number for number, line in enumerate(xml.splitlines(), 1) if WRONG in line)
        return [*found, *(WrongLine(line, WRONG) for line in wrong)], []


def findings(folder: Path) -> Figure:
    """The largest but one of some rounds; the floor is the same of the server's answer."""
    from browsers import chromium

    drawing = Drawing()
    with serving(drawing, folder) as address, chromium() as browser:
        page = browser.new_page(locale="en-GB", viewport={"width": 1280, "height": 800})
        page.goto(f"{address}/#editor/4")
        page.locator("[data-path='0.6.11']").click()  # below the root, which the picture shows
        page.get_by_label("record_name", exact=True).wait_for()
        found = page.evaluate(FOUND, [ROUNDS, RIGHT, WRONG])
        floor = page.evaluate(CHECKED, [ROUNDS, drawing.xml])
    return Figure("findings at 300 nodes", "ms", sorted(found)[-2], LIMIT, sorted(floor)[-2], usual_floor=USUAL)
