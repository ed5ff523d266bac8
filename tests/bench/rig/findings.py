"""From the change of a field in the editor to what the check finds at its node, painted: a task of 300 nodes."""

from __future__ import annotations

from bench.runner import Figure
from browsers import ask

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
  const marked = () => document.querySelector("[data-path='0.0.0'] .node_mark").textContent.trim() !== "";
  for (let i = 0; i < rounds; i += 1) {
    set.call(input, i % 2 ? right : wrong);
    input.dispatchEvent(new Event("input", { bubbles: true }));
    await frame();
    const begun = performance.now();
    input.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
    while (marked() !== (i % 2 === 0)) {
      await frame();
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


def findings(address: str) -> Figure:
    """The largest but one of some rounds; the floor is the same of the server's answer."""
    from browsers import chromium

    branch = f"<Sequence>{LEAF * LEAVES}</Sequence>"
    tree = f'<BehaviorTree ID="M"><Sequence>{branch * BRANCHES}</Sequence></BehaviorTree>'
    xml = f'<root main_tree_to_execute="M">{tree}</root>'
    task = ask(address, "/api/tasks", {"xml": xml, "description": "300 nodes"})["id"]
    with chromium() as browser:
        page = browser.new_page(locale="en-GB", viewport={"width": 1280, "height": 800})
        page.goto(f"{address}/#editor/{task}")
        page.locator("[data-path='0.0.0']").click()
        page.get_by_label("record_name", exact=True).wait_for()
        found = page.evaluate(FOUND, [ROUNDS, RIGHT, WRONG])
        floor = page.evaluate(CHECKED, [ROUNDS, xml])
    return Figure("findings at 300 nodes", "ms", sorted(found)[-2], LIMIT, sorted(floor)[-2], usual_floor=USUAL)
