"""What the pages make of states that a test makes up: silence, old places, long journals; no ROS, no mesh."""

import re
import socket
import threading
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
import yaml
from playwright.sync_api import Page, expect

from conftest import site_data
from tms_config.clock import utc_now
from tms_config.config import load_site
from tms_decision.reasons import SoftwareStop
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign, Reason
from tms_reason.remedies import REARM, RESUME
from tms_ur.access import Access
from tms_ur.api import create_app
from tms_ur.board import Board
from tms_ur.connections import Listener
from tms_ur.data_models import Record
from tms_ur.models import ActiveRun, AddedTemplate, Event, Host, Machine, Place, Process, Question, Rearmed, Run
from tms_ur.node import Server
from tms_ur.reason_view import view
from unit.tms_ur.fakes import NOON, FakeAudit, FakeSiteClient

pytestmark = pytest.mark.browser
MACHINES = ("zx200", "ic120")
SHAPE = {"paths": ["0"], "names": ["all"], "types": ["Sequence"], "kinds": ["control"], "ports": [""]}
WITH_TEMPLATE = {  # a task that calls the template Dig in its second node
    "paths": ["0", "0.0", "0.1"], "names": ["all", "own", "called"],
    "types": ["Sequence", "AlwaysSuccess", "AlwaysSuccess"],
    "kinds": ["control", "action", "action"], "ports": ["", "", ""], "templates": ["", "", "Dig:3"],
}  # fmt: skip
RUN = ActiveRun(run_id="r-1", task_id=4, state="running", machines=["zx200"])
LONG = 20_000  # events, as many as a browser replays


class Yard(FakeSiteClient):
    """Two machines, and a clock that the test turns."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 100.0
        self.board = Board(MACHINES, lambda: self.now)
        self.slow = threading.Event()  # until then zx200 does not answer
        self.journals: dict[str, list[Event]] = {}
        self.taken = False  # whether the template has another text

    def receive(self, **facts: Any) -> None:
        """Both machines and the scheduler."""
        for name in MACHINES:
            self.board.put_machine(Machine(name=name, state="standing", joint_age=0.1, **facts))
        self.board.put_runs([RUN])

    def rearm(self, machine: str, token: str) -> Rearmed:
        if machine == "zx200":
            self.slow.wait(60)
        return super().rearm(machine, token)

    def add_template(self, name: str, xml: str, description: str, replace: bool) -> AddedTemplate:
        if self.taken and not replace:
            raise TmsError(Foreign("it has another text"), "TEMPLATE_EXISTS")
        return super().add_template(name, xml, description, replace)

    def runs(self, limit: int) -> list[Run]:
        facts = {"task_id": 4, "description": "", "machines": [], "started_at": NOON, "ended_at": NOON}
        return [Run(run_id=name, state="abandoned", **facts, values={"nodes": 3}) for name in self.journals]

    def events(self, run_id: str, after: int, limit: int) -> list[Event]:
        return self.journals[run_id][after : after + limit] if self.journals else super().events(run_id, after, limit)

    def parameters(self, model_name: str) -> list[Record]:
        written = utc_now() - timedelta(seconds=30)
        facts = {"type": "static", "description": "", "source": "cli", "updated_at": written, "values": {"d": 1.0}}
        return [Record(model_name="zx200", record_name="pose", **facts)]


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
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(42, 20000, machines={name: {"model": name} for name in MACHINES})))
    listener = Listener(fileno=socket.create_server(("127.0.0.1", 0)).detach())
    application = create_app(yard, FakeAudit(), load_site(str(file)), Access(None))  # type: ignore[arg-type]
    server = Server(application, listener, None)
    yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    yard.slow.set()
    yard.board.close()
    server.stop()


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
    page.goto(f"{address}/#site")
    mark = page.locator("#map [data-machine=ic120]")
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


@pytest.mark.parametrize(("where", "box"), [("#tree", "#tree_box"), ("#history/r-1", "#past")])
def test_nodes_of_a_template_are_marked(page: Page, address: str, yard: Yard, where: str, box: str) -> None:
    """In the live tree and in that of a past run, whose journal names the template, too."""
    change = Event(number=2, stamp=NOON, kind="node", node="0.1", text="called IDLE -> SUCCESS")
    yard.journals = {"r-1": [event(1, "tree", **WITH_TEMPLATE), change]}
    page.goto(f"{address}/{where}")
    marked = page.locator(f"{box} [data-path]").filter(has=page.locator("rect.template"))
    expect(page.locator(f"{box} [data-path]")).to_have_count(3)
    expect(marked).to_have_count(1)
    expect(marked).to_have_attribute("data-path", "0.1")
    expect(marked.locator("title")).to_contain_text("(template Dig:3)")
    if box == "#past":
        expect(page.locator("#list_events tr").first.locator("[data-part=node]")).to_have_text("0.1 (template Dig:3)")
    page.locator("#language").click()
    expect(marked.locator("title")).to_contain_text("(テンプレート Dig:3)")


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
