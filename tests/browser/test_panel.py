"""The panel of one task: nothing moves before a person has read what will."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_decision.reasons import MachineLatched, SoftwareStop
from tms_ur.models import ActiveRun, TaskText
from tms_ur.reason_view import view
from yard import Yard, serving

pytestmark = pytest.mark.browser
XML = "<root><Sequence><L model_name='ic120'/><L model_name='zx200'/></Sequence></root>"


class Ready(Yard):
    """Its task moves both machines."""

    def task(self, task_id: int) -> TaskText:
        return super().task(task_id).model_copy(update={"xml": XML})

    def started(self) -> list[object]:
        return [call for call in self.calls if call[0] == "start_run"]


@pytest.fixture
def yard() -> Ready:
    yard = Ready()
    yard.receive()
    yard.board.put_runs([])
    yard.slow.set()
    return yard


@pytest.fixture
def panel(page: Page, yard: Ready, tmp_path: Path) -> Iterator[Page]:
    with serving(yard, tmp_path) as address:
        page.goto(f"{address}/panel.html?task=4")
        expect(page.locator("#task")).to_contain_text("掘削")
        yield page


def test_a_start_names_the_task_and_its_machines_and_asks_once(panel: Page, yard: Ready) -> None:
    panel.locator("#start").click()
    expect(panel.locator("#dialog_text")).to_contain_text("4 掘削")
    expect(panel.locator("#will_move li")).to_have_text(["ic120", "zx200"])
    for button in panel.locator("#dialog button").all():
        box = button.bounding_box()
        assert box and box["height"] >= 44
    found = Axe().run(panel)
    assert found.violations_count == 0, found.generate_report()
    panel.get_by_role("button", name="Back").click()
    expect(panel.locator("#start")).to_be_enabled()
    assert yard.started() == []
    panel.locator("#start").click()
    panel.get_by_role("button", name="Do it").click()
    expect(panel.locator("#message")).to_have_text("Run r-2 has begun.")
    assert yard.started() == [("start_run", 4, False)]


def test_a_machine_is_stopped_from_inside_the_question(panel: Page, yard: Ready) -> None:
    panel.locator("#start").click()
    panel.locator("#dialog_stop").click()
    expect(panel.locator("#stop_report")).to_contain_text("zx200: seen to stand")
    assert yard.started() == []


def test_what_helps_asks_too(panel: Page, yard: Ready) -> None:
    """Its button used to fail, as nothing on this page could ask."""
    run = ActiveRun(run_id="r-1", task_id=4, state="running", machines=["zx200"])
    yard.board.put_runs([run.model_copy(update={"reason": view(MachineLatched("zx200", SoftwareStop()))})])
    panel.get_by_role("button", name="Look at the machine, then re-arm it").click()
    expect(panel.locator("#dialog_text")).to_contain_text("zx200 was stopped")
    panel.locator("#dialog_yes").click()
    expect(panel.locator("#message")).to_have_text("zx200 is armed.")
