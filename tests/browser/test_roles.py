"""Who one is stands above every page, and nobody sees a button that the server would refuse."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_decision.reasons import SoftwareStop
from tms_ur.access import hashed
from tms_ur.models import Host, Process, Question, Run
from tms_ur.place_models import SharedPlace, SharedPlaces
from tms_ur.reason_view import of_line, view
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, serving

pytestmark = [pytest.mark.turns, pytest.mark.browser]
PASSWORD = "open-sesame"
LOOKS = {"board": "#list_interrupted li", "tasks": "#list_stored tr", "data": "#list_records tr", "map": "#map_box",
         "system": "#list_processes tr"}  # fmt: skip
# What a button says to whom it is shown, by page and by the role that the server asks for.
OPERATOR = {
    "board": ["Run task 4", "Re-arm zx200", "Cancel run r-1", "Resume run r-9", "Give up run r-9", "Yes", "No",
              "Take ramp from its holder"],
    "tasks": ["Start task 4"],
    "system": ["Restart tms:db"],
}  # fmt: skip
ADMIN = {"tasks": ["Remove task 4"], "data": ["New record", "Edit zx200/pose"]}


class Busy(Yard):
    """Something of everything that somebody may command."""

    def runs(self, limit: int) -> list[Run]:
        facts = {"run_id": "r-9", "task_id": 4, "description": "", "machines": ["zx200"], "started_at": NOON}
        return [Run(**facts, state="interrupted", reason=of_line("lost"), ended_at=NOON)]

    def happen(self) -> None:
        self.receive(latch=view(SoftwareStop()))
        self.board.put_runs([RUN], [Question(id="q", run_id="r-1", node="0", title="Safety", text="Clear?")])
        held = SharedPlace(name="ramp", state="held", holder="zx200", queue=[], reason=None, run="", since=NOON)
        self.board.put_shared(SharedPlaces(places=[held]))
        self.board.put_host(Host(name="pc", processes=[Process(name="tms:db", state="RUNNING")]))


@pytest.fixture
def yard() -> Busy:
    yard = Busy()
    yard.happen()
    return yard


@pytest.fixture
def guarded(yard: Busy, tmp_path: Path) -> Iterator[str]:
    """A console with a user of each role."""
    users = tmp_path / "users.yaml"
    people = {name: {"role": name, "password": hashed(PASSWORD)} for name in ("viewer", "operator", "admin")}
    users.write_text(yaml.safe_dump({"users": people}))
    users.chmod(0o600)
    with serving(yard, tmp_path, users) as address:
        yield address


def login(page: Page, address: str, name: str) -> None:
    page.goto(address)
    page.locator("#login_name").fill(name)
    page.locator("#login_password").fill(PASSWORD)
    page.locator("#login button").click()
    expect(page.locator("#who")).to_contain_text(name)


@pytest.mark.parametrize("role", ["viewer", "operator", "admin"])
def test_only_buttons_that_the_server_obeys_are_shown(page: Page, guarded: str, yard: Busy, role: str) -> None:
    login(page, guarded, role)
    for name, shown in LOOKS.items():
        page.goto(f"{guarded}/#{name}")
        yard.happen()
        expect(page.locator(shown).first).to_be_visible()
        for needed, buttons in (("operator", OPERATOR), ("admin", ADMIN)):
            for text in buttons.get(name, []):
                allowed = ["viewer", "operator", "admin"].index(role) >= ["viewer", "operator", "admin"].index(needed)
                expect(page.get_by_role("button", name=text, exact=True)).to_have_count(1 if allowed else 0)
    page.goto(f"{guarded}/#board")
    page.get_by_role("button", name="Check task 4").click()  # everybody may look
    expect(page.locator("#checked")).to_contain_text("there is no node 'Dig'")
    page.locator("#stop").click()  # and stop
    expect(page.locator("#stop_report")).to_contain_text("zx200: seen to stand")


def test_a_viewer_reads_what_helps_and_can_only_stop_on_the_panel(page: Page, guarded: str, yard: Busy) -> None:
    login(page, guarded, "viewer")
    page.goto(f"{guarded}/panel.html?task=4")
    yard.happen()
    expect(page.locator("#questions .question")).to_be_visible()
    expect(page.get_by_role("button", name="Yes")).to_be_hidden()
    expect(page.get_by_role("button", name="No", exact=True)).to_be_hidden()
    expect(page.locator("#start")).to_be_hidden()
    expect(page.locator("#stop")).to_be_visible()


def test_a_click_on_the_map_makes_no_record_for_whom_may_not(page: Page, guarded: str) -> None:
    login(page, guarded, "operator")
    page.goto(f"{guarded}/#map")
    page.get_by_role("button", name="Draw areas").click()
    expect(page.locator("#area_editor")).to_contain_text("Enabling areas needs the role admin.")
    page.locator("#area_editor").get_by_role("button", name="Close").click()
    page.locator("#map_box").click()
    expect(page.locator("#place_form")).to_have_count(0)


def test_without_users_the_page_says_that_nobody_logs_in(page: Page, yard: Busy, tmp_path: Path) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    with serving(yard, tmp_path) as address:
        page.goto(f"{address}/#board")
        who = page.locator("#who")
        expect(who).to_have_text("no login: everybody may operate")
        expect(who).to_be_visible()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        expect(page.locator("#list_interrupted li")).to_be_visible()
        found = Axe().run(page)
        assert found.violations_count == 0, found.generate_report()
        page.locator("#language").click()
        expect(who).to_have_text("ログインなし: 誰でも操作できます")
