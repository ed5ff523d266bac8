"""What the pages make of states that a test makes up: silence, old places, long journals; no ROS, no mesh."""

import re
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tms_config.clock import utc_now
from tms_decision.reasons import SoftwareStop
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_reason.remedies import REARM, RESUME
from tms_ur.models import Event, Host, Place, Process, Question
from tms_ur.reason_view import view
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, serving

pytestmark = pytest.mark.browser
SHAPE = {"paths": ["0"], "names": ["all"], "types": ["Sequence"], "kinds": ["control"], "ports": [""]}
WITH_TEMPLATE = {  # a task that calls the template Dig in its second node
    "paths": ["0", "0.0", "0.1"], "names": ["all", "own", "called"],
    "types": ["Sequence", "AlwaysSuccess", "AlwaysSuccess"],
    "kinds": ["control", "action", "action"], "ports": ["", "", ""], "templates": ["", "", "Dig:3"],
}  # fmt: skip
LONG = 20_000  # events, as many as a browser replays


class PageLatch(Reason, text="{machine} is made to wait", action=REARM, details="seen on {topic}"):
    machine: str
    topic: str


class PageInterruption(Reason, text="run {run} was interrupted", action=RESUME):
    run: str


@pytest.fixture
def yard() -> Yard:
    yard = Yard()
    yard.receive()
    return yard


@pytest.fixture
def address(yard: Yard, tmp_path: Path) -> Iterator[str]:
    """Where the console of the yard is."""
    with serving(yard, tmp_path) as address:
        yield address


def event(number: int, kind: str = "node", **values: Any) -> Event:
    return Event(number=number, stamp=NOON, kind=kind, node="0", text=f"entry {number}", values=values)


def test_one_yes_arms_one_machine(page: Page, address: str, yard: Yard) -> None:
    yard.receive(latch=view(SoftwareStop()))
    page.goto(f"{address}/#board")
    late = page.get_by_role("button", name="Re-arm zx200")
    late.click()
    page.get_by_role("button", name="Re-arm ic120").click()
    expect(page.locator("#dialog_text")).to_contain_text("ic120 was stopped")
    yard.slow.set()
    expect(late).to_be_enabled()  # it asks for nothing: the question is another machine's
    expect(page.locator("#dialog_text")).to_contain_text("ic120 was stopped")
    page.locator("#dialog_yes").click()
    expect(page.locator("#message")).to_have_text("ic120 is armed.")
    assert [call[1] for call in yard.calls if call[0] == "rearm" and call[2]] == ["ic120"]


def test_a_reason_has_what_helps_and_its_details(page: Page, address: str, yard: Yard) -> None:
    """In the language of the page, and the command where the console has no button."""
    yard.slow.set()
    latched = PageLatch("zx200", "/zx200/rc/state")
    yard.board.put_runs([RUN.model_copy(update={"reason": view(latched)})])
    page.goto(f"{address}/#board")
    row = page.locator("#list_active [data-part=reason]")
    expect(row).to_contain_text("zx200 is made to wait")
    expect(row.locator("details span")).to_be_hidden()
    row.locator("summary").click()
    expect(row.locator("details span")).to_have_text("seen on /zx200/rc/state")
    row.get_by_role("button", name="Look at the machine, then re-arm it").click()
    expect(page.locator("#dialog_text")).to_contain_text("zx200 was stopped")
    page.locator("#dialog_yes").click()
    expect(page.locator("#message")).to_have_text("zx200 is armed.")
    page.locator("#language").click()
    expect(row.locator("summary")).to_have_text("詳細")
    expect(row.get_by_role("button", name="機械を確認してから")).to_be_visible()
    yard.error = TmsError(PageInterruption("r-1"))
    page.locator("#list_tasks button").first.click()
    expect(page.locator("#message button")).to_be_visible()
    yard.error = None
    page.locator("#message button").click()
    expect(page.locator("#dialog_text")).to_contain_text("タスク 4 を再開しますか")


def test_a_silent_scheduler_is_told_on_panel_and_tree(page: Page, address: str, yard: Yard) -> None:
    silent = "The scheduler (tms:ts) does not answer."
    page.goto(f"{address}/panel.html?task=4")
    expect(page.locator("#state")).to_have_text("Running: It moves on.")
    yard.now += 6
    expect(page.locator("#state")).to_contain_text(silent)
    page.goto(f"{address}/#tree")
    expect(page.locator("#tree_reason")).to_contain_text(silent)
    expect(page.locator("#tree_state")).to_contain_text("Unknown")
    yard.receive()
    expect(page.locator("#tree_reason")).to_have_text("It moves on.")
    yard.board.put_runs([])
    yard.now += 6
    page.reload()
    expect(page.locator("#no_tree")).to_contain_text(silent)  # and not that nothing runs


def test_a_field_of_a_run_that_nobody_has_translated_is_shown(page: Page, address: str, yard: Yard) -> None:
    yard.journals = {"r-1": [event(1)]}
    page.goto(f"{address}/#history/r-1")
    expect(page.locator("#past_values li")).to_have_text(["nodes: 3"])


def test_an_old_place_is_marked(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.0))
    page.goto(f"{address}/#map")
    mark = page.locator("#map_box [data-machine=ic120]")
    expect(mark).to_have_attribute("class", "machine standing")
    expect(page.locator("#unplaced li")).to_have_text(["zx200: no position has been heard."])
    yard.now += 7
    yard.receive()  # its joints go on
    expect(mark).to_have_attribute("class", "machine silent")
    expect(page.locator("#unplaced li").last).to_have_text("ic120: no position for 7.0 s; the map shows the last one.")


def test_the_processes_of_a_silent_pc_are_unknown(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_host(Host(name="pc", processes=[Process(name="tms:ts", state="RUNNING", pid=7, uptime=5.0)]))
    page.goto(f"{address}/#system")
    row = page.locator("#list_processes tr")
    expect(row).to_contain_text("Running5.0 s")
    yard.now += 7
    expect(row).to_contain_text("Unknown---")


def test_ages_are_told_by_the_clock_of_the_site(page: Page, address: str, yard: Yard) -> None:
    until = utc_now() + timedelta(seconds=300)
    asked = Question(id="q", run_id="r-1", node="0", title="Safety", text="Clear?", until=until)
    yard.board.put_runs([RUN], [asked])
    page.clock.install(time=utc_now() + timedelta(hours=1))
    page.goto(f"{address}/#data")
    expect(page.locator("#questions .question")).to_contain_text(re.compile(r"\b[12]\d\d s left"))
    expect(page.locator("#list_records [data-part=age]")).to_have_text(re.compile(r"^\d\d s$"))


def test_a_long_journal_says_that_it_was_cut(page: Page, address: str, yard: Yard) -> None:
    yard.journals = {"whole": [event(n) for n in range(1, LONG + 1)], "more": [event(n) for n in range(1, LONG + 2)]}
    page.goto(f"{address}/#history/whole")
    expect(page.locator("#receipts")).to_have_text("Nothing was stopped.")
    expect(page.locator("#journal_cut")).to_be_empty()
    page.get_by_role("button", name="Show run more").click()
    expect(page.locator("#journal_cut")).to_contain_text("its first 20000 entries")
    expect(page.locator("#receipts")).to_have_text("No stop in the part that is shown.")


def test_a_refused_run_shows_no_tree(page: Page, address: str, yard: Yard) -> None:
    yard.journals = {"ran": [event(1, "tree", **SHAPE)], "refused": [event(1, "run")]}
    page.goto(f"{address}/#history/ran")
    expect(page.locator("#past [data-path]")).to_be_visible()
    page.get_by_role("button", name="Show run refused").click()
    expect(page.locator("#past_title")).to_have_text("Run refused")
    expect(page.locator("#past [data-path]")).to_be_hidden()
    page.locator("#language").click()
    expect(page.locator("#list_history tr").first).to_contain_text("打ち切り")
    page.locator("button", has_text="表示").first.click()
    expect(page.locator("#past [data-path]")).to_be_visible()


def journal_of_template(yard: Yard) -> None:
    change = Event(number=2, stamp=NOON, kind="node", node="0.1", text="called IDLE -> SUCCESS")
    yard.journals = {"r-1": [event(1, "tree", **WITH_TEMPLATE), change]}


def test_nodes_of_a_template_are_marked_in_the_live_tree(page: Page, address: str, yard: Yard) -> None:
    journal_of_template(yard)
    page.goto(f"{address}/#tree")
    nodes = page.locator("#tree_box [data-path]")
    marked = nodes.filter(has=page.locator(".from_template"))
    expect(nodes).to_have_count(3)
    expect(marked).to_have_attribute("data-path", "0.1")
    expect(marked).to_have_attribute("title", re.compile(r"\(template Dig:3\)"))
    marked.click()
    expect(page.locator("#node_details")).to_contain_text("template Dig:3")
    page.locator("#language").click()
    expect(marked).to_have_attribute("title", re.compile(r"\(テンプレート Dig:3\)"))


def test_nodes_of_a_template_are_marked_in_the_history(page: Page, address: str, yard: Yard) -> None:
    """Whose journal names the template, too."""
    journal_of_template(yard)
    page.goto(f"{address}/#history/r-1")
    marked = page.locator("#past [data-path]").filter(has=page.locator(".from_template"))
    expect(page.locator("#past [data-path]")).to_have_count(3)
    expect(marked).to_have_attribute("data-path", "0.1")
    expect(marked).to_have_attribute("title", re.compile(r"\(template Dig:3\)"))
    expect(page.locator("#list_events tr").first.locator("[data-part=node]")).to_have_text("0.1 (template Dig:3)")
    page.locator("#language").click()
    expect(marked).to_have_attribute("title", re.compile(r"\(テンプレート Dig:3\)"))


def test_the_cursor_of_a_run_goes_by_time(page: Page, address: str, yard: Yard) -> None:
    """The address of a moment opens it; what is clicked on in the journal is gone to."""
    change = {"kind": "node", "node": "0.1"}
    later = [NOON + timedelta(seconds=seconds) for seconds in (0, 10, 30)]
    yard.journals = {"r-1": [
        event(1, "tree", **WITH_TEMPLATE),
        Event(number=2, stamp=later[1], text="called IDLE -> RUNNING", **change),
        Event(number=3, stamp=later[2], text="called RUNNING -> SUCCESS", **change),
    ]}  # fmt: skip
    page.goto(f"{address}/#history/r-1/12.5")
    node = page.locator("#past [data-path='0.1']")
    expect(node).to_have_attribute("data-state", "running")
    page.locator("#slider").fill("300")  # tenths of a second
    expect(node).to_have_attribute("data-state", "success")
    page.locator("#list_events tr", has_text="IDLE -> RUNNING").get_by_role("button").click()
    expect(node).to_have_attribute("data-state", "running")
    expect(page.get_by_role("link", name="Link to this moment")).to_have_attribute("href", "#history/r-1/10.0")


def test_a_file_is_stored_as_a_template_under_its_name(page: Page, address: str, yard: Yard) -> None:
    yard.taken = True
    page.goto(f"{address}/#tasks")
    expect(page.locator("#list_templates tr [data-part=name]")).to_have_text("Dig")
    text = "<root><BehaviorTree ID='Dig'/></root>"
    page.locator("#file").set_input_files({"name": "Dig.xml", "mimeType": "text/xml", "buffer": text.encode()})
    page.get_by_role("button", name="Store as template").click()
    expect(page.locator("#dialog_text")).to_have_text("Template Dig is stored with another text. Replace it?")
    page.locator("#dialog_yes").click()
    expect(page.locator("#message")).to_have_text("Stored as template Dig.")
    assert [call for call in yard.calls if call[0] == "add_template"] == [("add_template", "Dig", text, "", True)]
