"""What a site engineer stumbled over in the first trial of the console, and stumbles over no more.

The others of that trial are elsewhere: fit and follow in test_tree.py, a stopped site, interrupted runs and one-click
starts in test_board.py, processes and logs in test_made_up.py, phones in test_phone.py, Japanese in test_japanese.py.
"""

from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tms_proof.reasons import Frozen, JointStates, Stalled
from tms_reason.reason import Reason
from tms_ur.data_models import Record
from tms_ur.models import Event, Machine
from tms_ur.reason_view import view
from unit.tms_ur.fakes import NOON, WrongLine
from yard import RUN, Yard, serving

pytestmark = [pytest.mark.turns, pytest.mark.browser]
TWO_MACHINES = "<root><Sequence><L model_name='ic120'/><L model_name='zx200'/></Sequence></root>"
POLLS = 40  # times that a journal tells the same


class Trial(Yard):
    """A task of two machines, a record of joint angles, and a check that finds the same five times."""

    def task(self, task_id: int) -> object:  # type: ignore[override]
        return super().task(task_id).model_copy(update={"xml": TWO_MACHINES})

    def parameters(self, model_name: str) -> list[Record]:
        facts = {"type": "static", "description": "", "source": "cli", "updated_at": NOON}
        return [Record(model_name="zx200", record_name="UP", values={"boom_joint": -0.5}, **facts,
                       types={"boom_joint": "double"}, units={"boom_joint": "rad"})]  # fmt: skip

    def check_task(self, xml: str, motions: bool = True) -> tuple[list[Reason], list[Reason]]:
        return [WrongLine(line, "Dig") for line in range(1, 6)], []


@pytest.fixture
def yard() -> Trial:
    yard = Trial()
    yard.receive()
    return yard


@pytest.fixture
def address(yard: Trial, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


def test_a_machine_that_stalls_is_not_told_to_move(page: Page, address: str, yard: Trial) -> None:
    """Its card says what its gateway has found, in place of a motion and a share of it."""
    card, light = page.locator("[data-machine=zx200]"), page.locator("#light")
    yard.board.put_machine(Machine(name="zx200", state="moving", joint_age=0.1))
    page.goto(f"{address}/#board")
    expect(card.locator(".badge").first).to_have_text("▶ Moving")
    yard.board.put_machine(Machine(name="zx200", state="standing", joint_age=0.1))
    yard.board.put_runs([RUN.model_copy(update={"reason": view(Stalled("boom_joint", -0.3, -0.5))})])
    expect(card.locator(".badge").first).to_have_text("■ Standing")
    expect(card).to_contain_text("Waits: boom_joint stands at -0.300 rad")
    expect(card).not_to_contain_text("Moving")
    expect(card).not_to_contain_text("%")
    stuck = view(Frozen(JointStates(), 1.2))
    yard.board.put_machine(Machine(name="zx200", state="standing", joint_age=0.1, latch=stuck))
    expect(card).to_contain_text("Stopped because: joint states are the same to the last bit for 1.2 s")
    expect(light).to_contain_text("Stopped zx200")


def test_tasks_name_all_machines_that_they_move(page: Page, address: str) -> None:
    page.goto(f"{address}/#tasks")
    row = page.locator("#list_stored tr")
    expect(page.locator(".scroll:has(#list_stored) th").nth(1)).to_have_text("Machines")
    expect(row.locator("td").nth(1)).to_have_text("ic120, zx200")


def test_runs_side_by_side_are_told_apart(page: Page, address: str, yard: Trial) -> None:
    """Each with its own line, reason and buttons; each machine is that of its own run."""
    yard.slow.set()
    waits = view(Stalled("vessel_joint", 0.1, 0.4))
    other = RUN.model_copy(update={"run_id": "r-2", "task_id": 7, "machines": ["ic120"], "reason": waits})
    yard.board.put_runs([RUN, other])
    page.goto(f"{address}/#board")
    rows = page.locator("#list_active li")
    expect(rows).to_have_count(2)
    expect(rows.nth(0)).to_contain_text("Task 4")
    expect(rows.nth(0)).to_contain_text("zx200")
    expect(rows.nth(0)).not_to_contain_text("vessel_joint")
    expect(rows.nth(1)).to_contain_text("Task 7")
    expect(rows.nth(1)).to_contain_text("vessel_joint stands at")
    for machine, task in (("zx200", "Task 4"), ("ic120", "Task 7")):
        expect(page.locator(f"#list_machines [data-machine={machine}] a.button")).to_have_text(task)
    rows.nth(1).get_by_role("button", name="Cancel run r-2").click()
    expect(page.locator("#message")).not_to_be_empty()
    assert [call[1] for call in yard.calls if call[0] == "cancel_run"] == ["r-2"]


def test_nodes_say_what_they_do_and_ask(page: Page, address: str, yard: Trial) -> None:
    """Machine, subtask and record of a leaf, the condition of a condition, and a name that a person gave."""
    tree = {
        "paths": ["0", "0.0", "0.1", "0.2"],
        "names": ["load the truck", "LeafNodeZx200", "BlackboardCheck", "Fallback"],
        "types": ["Sequence", "LeafNodeZx200", "BlackboardCheck", "Fallback"],
        "kinds": ["control", "action", "condition", "control"],
        "ports": ["", 'model_name="zx200" subtask_name="dig" record_name="PIT"', 'key="full" value="true"', ""],
    }
    yard.journals = {"r-1": [Event(number=1, stamp=NOON, kind="tree", node="", text="", values=tree)]}
    page.goto(f"{address}/#history/r-1")
    for path, text in (("0", "load the truck"), ("0.1", 'key="full" value="true"'), ("0.0", "zx200: dig PIT")):
        expect(page.locator(f"#past [data-path='{path}'] .node_label")).to_have_text(text)


def test_polling_does_not_flood_the_journal(page: Page, address: str, yard: Trial) -> None:
    """Repeats are one row with their number; kinds and words filter."""
    events = [Event(number=1, stamp=NOON, kind="run", node="", text="the run began")]
    for number in range(POLLS):
        stamp = NOON + timedelta(seconds=number)
        text = f"full {'FAILURE -> RUNNING' if number % 2 else 'RUNNING -> FAILURE'}"
        events.append(Event(number=number + 2, stamp=stamp, kind="node", node="0.1", text=text))
    yard.journals = {"r-1": events}
    page.goto(f"{address}/#history/r-1")
    rows = page.locator("#list_events tr")
    expect(rows).to_have_count(3)
    expect(rows.first).to_contain_text(f"×{POLLS // 2}")
    bar = page.locator("#past .bar:has([type=search])").last
    bar.get_by_label("Event").select_option("run")
    expect(rows).to_have_count(1)
    expect(rows).to_contain_text("the run began")
    bar.get_by_label("Event").select_option("")
    bar.get_by_label("Filter").fill("-> FAILURE")
    expect(rows).to_have_count(1)
    bar.get_by_role("button", name="Fold repeats").click()
    expect(rows).to_have_count(POLLS // 2)


def test_a_value_beyond_its_limit_is_refused_where_it_is_entered(page: Page, address: str, yard: Trial) -> None:
    page.goto(f"{address}/#data")
    page.get_by_role("button", name="Edit zx200/UP").click()
    form = page.locator("#editor")
    form.locator("[data-field=boom_joint]").fill("9.0")
    form.get_by_role("button", name="Save").click()
    problem = page.locator("#editor_problem")
    expect(problem).to_contain_text("boom_joint: 9.000 rad")
    expect(problem).to_contain_text("limit")
    assert [call for call in yard.calls if call[0] == "set_parameter"] == []
    form.locator("[data-field=boom_joint]").fill("-0.4")
    form.get_by_role("button", name="Save").click()
    expect(page.locator("#message")).to_have_text("zx200/UP was saved.")
    written: list[Any] = [call[3] for call in yard.calls if call[0] == "set_parameter"]
    assert written == [{"boom_joint": -0.4}]


def test_findings_of_a_kind_are_together(page: Page, address: str) -> None:
    page.goto(f"{address}/#tasks")
    given = {"name": "task.xml", "mimeType": "text/xml", "buffer": TWO_MACHINES.encode()}
    page.locator("#file").set_input_files(given)  # type: ignore[arg-type]
    found = page.locator("#findings")
    expect(found.locator("h3")).to_have_text("Errors (5)")
    expect(found.locator("li[data-line]:visible")).to_have_count(3)
    found.get_by_text("2 more of this kind").click()
    expect(found.locator("li[data-line]:visible")).to_have_count(5)
