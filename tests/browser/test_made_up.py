"""What the pages make of states that a test makes up: silence, old places, long journals; no ROS, no mesh."""

import re
import threading
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_config.clock import utc_now
from tms_decision.reasons import SoftwareStop
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign, Reason
from tms_reason.remedies import REARM, RESUME
from tms_ts.bt import check, palette
from tms_ur.models import Event, Host, Place, Process, Question
from tms_ur.reason_view import view
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, log_line, serving, shape

pytestmark = [pytest.mark.turns, pytest.mark.browser]
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


def test_the_map_stays_where_it_is_until_it_is_moved(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.0))
    page.goto(f"{address}/#map")
    picture, mark = page.locator("#site_map"), page.locator("#map_box [data-machine=ic120] polygon").first
    before, drawn = picture.get_attribute("viewBox"), mark.get_attribute("points")
    yard.board.put_place("ic120", Place(x=90.0, y=2.0, yaw=0.0))
    expect(mark).not_to_have_attribute("points", drawn or "")
    expect(picture).to_have_attribute("viewBox", before or "")
    page.locator("#follow").select_option("ic120")
    expect(picture).not_to_have_attribute("viewBox", before or "")
    page.goto(f"{address}/#map/3d")
    expect(page.locator("#space")).to_have_attribute("data-pictures", re.compile(r"\d"))


def test_the_way_that_a_machine_drives_is_on_the_map(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.0))
    page.goto(f"{address}/#map")
    expect(page.locator("#map_box [data-machine=ic120]").first).to_be_visible()
    way = page.locator("#map_box polyline.way")
    expect(way).to_have_count(0)
    yard.board.put_way("ic120", [(1.0, 2.0), (7.0, 3.0)])
    expect(way).to_have_attribute("points", "1.00,-2.00 7.00,-3.00")


def test_a_place_on_the_map_becomes_a_record(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.0))
    page.goto(f"{address}/#map")
    expect(page.locator("#map_box [data-area=yard]")).to_be_visible()
    box, form = page.locator("#map_box"), page.locator("#place_form")
    box.click(position={"x": 8, "y": 8})
    expect(form.get_by_role("alert")).to_contain_text("lies outside the areas where machines may be")
    form.get_by_label("Name of the record").fill("HERE")
    expect(form.get_by_role("button", name="Save")).to_have_count(0)
    box.click()
    form.get_by_label("Name of the record").fill("HERE")
    form.get_by_label("Heading").fill("180")
    form.get_by_role("button", name="Save").click()
    expect(page.locator("#message")).to_have_text("ic120/HERE was saved.")
    (call,) = (one for one in yard.calls if one[0] == "set_parameter")
    values: Any = call[3]
    assert (call[1], call[2], call[5]) == ("ic120", "HERE", True)
    assert values["x"] == pytest.approx(7.5, abs=0.1) and values["qz"] == pytest.approx(1.0)


def test_areas_are_drawn_and_enabled_as_they_were_checked(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.0))
    page.goto(f"{address}/#map")
    expect(page.locator("#map_box [data-area=yard]")).to_be_visible()
    page.get_by_role("button", name="Draw areas").click()
    page.get_by_role("button", name="New area").click()
    box, editor = page.locator("#map_box"), page.locator("#area_editor")
    editor.get_by_label("Name").fill("pit")
    editor.get_by_label("Type").select_option("blocked")
    for x, y in ((600, 200), (700, 200), (700, 300)):
        box.click(position={"x": x, "y": y})
    expect(box.locator("[data-draft=pit]")).to_have_class(re.compile("blocked"))
    editor.get_by_role("button", name="Check").click()
    expect(editor.locator("[data-part=changes]")).to_have_text(
        "yard: changed, 625.0 m² to 600.0 m², 25.0 m² less, 0.0 m² more"
    )
    with page.expect_download() as file:
        editor.get_by_role("button", name="Save as GeoJSON").click()
    assert file.value.suggested_filename == "areas.geojson"
    editor.get_by_role("button", name="Enable").click()
    expect(page.locator("#dialog_text")).to_contain_text("25.0 m² less")
    page.locator("#dialog_yes").click()
    expect(page.locator("#message")).to_have_text("The areas are enabled.")
    (call,) = (one for one in yard.calls if one[0] == "enable_areas")
    drawn: Any = call[1]
    assert [one["properties"]["id"] for one in drawn["features"]] == ["yard", "pit"] and call[2] == "a0"


def test_the_processes_of_a_silent_pc_are_unknown(page: Page, address: str, yard: Yard) -> None:
    yard.board.put_host(Host(name="pc", processes=[Process(name="tms:ts", state="RUNNING", pid=7, uptime=5.0)]))
    page.goto(f"{address}/#system")
    row = page.locator("#list_processes tr")
    expect(row).to_contain_text("Running5.0 s")
    yard.now += 7
    expect(row).to_contain_text("Unknown---")


def test_a_stopped_process_is_a_fault_only_where_it_should_run(page: Page, address: str, yard: Yard) -> None:
    """And the alarm leads to its log."""
    rows = [Process(name="zx200:st_swing", state="STOPPED", on_demand=True), Process(name="tms:db", state="STOPPED")]
    yard.board.put_host(Host(name="pc", processes=rows))
    page.goto(f"{address}/#system")
    expect(page.get_by_role("region", name="Always running").locator("#list_processes tr")).to_contain_text(
        ["tms:dbpc! Down"]
    )
    expect(page.get_by_role("region", name="Started on demand").locator("tbody tr")).to_contain_text(
        ["zx200:st_swingpc■ On demand"]
    )
    expect(page.locator("#no_alarms")).to_be_visible()
    yard.board.snapshot()
    yard.now += 15
    yard.receive()
    yard.board.put_host(Host(name="pc", processes=rows))
    expect(page.locator("#list_alarms li")).to_contain_text(["process tms:db does not run"])
    page.get_by_role("link", name="Read the log of the process").click()
    expect(page.locator("#log_text")).to_have_text("event=started")
    expect(page.locator("#log_text")).to_be_in_viewport()
    page.locator("#log_filter").fill("ended")
    expect(page.locator("#log_text")).to_be_empty()


def test_the_logs_of_a_machine_in_one(page: Page, address: str, yard: Yard, monkeypatch: pytest.MonkeyPatch) -> None:
    """Chosen by hand; the address names it, and a PC that is away is named."""
    logs = {"zx200:rc": log_line(2, "WARNING", "event=late"), "zx200:st": log_line(1), "tms:ts": log_line(0)}
    monkeypatch.setattr(yard, "log", lambda process, size: logs[process])
    yard.board.put_host(Host(name="far", processes=[Process(name="zx200:mc", state="RUNNING")]))
    yard.now += 7
    yard.receive()
    yard.board.put_host(Host(name="pc", processes=[Process(name=name, state="RUNNING") for name in logs]))
    page.goto(f"{address}/#system")
    page.get_by_role("combobox", name="Log of").select_option("Machine")
    page.get_by_role("combobox", name="Machine", exact=True).select_option("zx200")
    text = page.locator("#log_text")
    expect(text).to_have_text(re.compile(r"^.* INFO zx200:st event=begun\n.* WARNING zx200:rc event=late$"))
    expect(page.locator("#log")).to_contain_text("The log of zx200:mc cannot be read: PC far says nothing")
    page.locator("#log_filter").fill("late")
    expect(text).to_have_text(re.compile(r"^.* WARNING zx200:rc event=late$"))
    page.reload()
    expect(text).to_contain_text("event=begun")
    page.goto(f"{address}/#system/run/r-1")
    expect(page.locator("#log_name")).to_have_value("r-1")
    expect(text).to_contain_text("tms:ts event=begun")


def test_the_log_of_a_run_follows_the_cursor(
    page: Page, address: str, yard: Yard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A line puts the cursor where it is; the log is asked for once, when it is opened."""
    facts = {"node": "0", "text": "x IDLE -> RUNNING"}
    tree = Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**shape(1, 1)})
    late = Event(number=2, stamp=NOON + timedelta(seconds=4), kind="node", **facts)
    yard.journals = {"r-1": [tree, late]}
    lines = [log_line(1), log_line(3, "ERROR", "event=lost"), log_line(4.5)]
    monkeypatch.setattr(yard, "log", lambda process, size: "".join(lines))
    yard.unrecorded = True
    yard.board.put_runs([])
    yard.board.put_host(Host(name="pc", processes=[Process(name="tms:ts", state="RUNNING")]))
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if "/api/logs" in request.url else None)
    page.goto(f"{address}/#history/r-1")
    expect(page.locator("#past [data-path]").first).to_be_visible()
    assert not asked
    page.get_by_text("Log up to the cursor").click()
    rows = page.locator("#run_log .log_line")
    expect(rows).to_have_count(2)  # up to the last event
    lost = rows.nth(1)
    expect(lost).to_contain_text("⬣ ERROR tms:ts event=lost")
    box = lost.bounding_box()
    assert box and box["height"] >= 44
    lost.click()
    expect(page.locator("#slider")).to_have_value("30")
    page.locator("#slider").fill("15")
    expect(rows).to_have_count(1)
    page.locator("#slider").fill("40")
    expect(rows).to_have_count(2)
    assert len(asked) == 1


def test_long_lines_of_a_log_leave_the_buttons_of_its_process_on_the_page(page: Page, address: str, yard: Yard) -> None:
    details = Foreign("pid 16797, uptime 0:01:16")  # what supervisord says of each process that runs
    found = Process(name="tms:ts", state="RUNNING", pid=16797, uptime=78.0, detail=view(details))
    yard.board.put_host(Host(name="site-pc-1", processes=[found]))
    page.route("**/api/processes/*/log*", lambda route: route.fulfill(json={"text": "event=started " * 100}))
    page.goto(f"{address}/#system/tms:ts")
    expect(page.locator("#log_text")).to_contain_text("event=started")
    expect(page.get_by_role("button", name="Restart tms:ts")).to_be_in_viewport(ratio=1.0)
    row = page.locator("#list_processes tr").first
    expect(row).not_to_contain_text("uptime 0:01:16")
    assert row.evaluate("row => [...row.cells].every(cell => cell.offsetHeight < 70)")


def test_the_history_of_a_record_is_a_plot(page: Page, address: str, yard: Yard) -> None:
    page.goto(f"{address}/#data")
    page.get_by_role("button", name="History of zx200/pose").click()
    expect(page.locator("#values canvas")).to_be_visible()
    expect(page.locator("#list_values")).to_contain_text("d: 1")


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


def test_the_work_of_a_day_is_beside_its_plan(page: Page, tmp_path: Path) -> None:
    yard = Yard(ground={"area": [-10.0, -10.0, 10.0, 10.0], "plan": {"bank": 16.0, "loads": 4}})
    yard.receive()
    with serving(yard, tmp_path) as address:
        page.goto(f"{address}/#work/2026-11-26")
        expect(page.locator("[data-plan=bank_m3]")).to_contain_text("8.0 of 16.0 (50 %)")
        expect(page.locator("[data-plan=truck_loads]")).to_contain_text("1 of 4 (25 %)")
        expect(page.locator("#list_work tr")).to_have_count(3)
        expect(page.locator("#list_work tr").last).to_contain_text("all108.0010.00")
        expect(page.locator("#list_hours tr")).to_have_count(2)
        expect(page.locator("#list_parts tr").first).to_contain_text("Dig2.0")
        assert Axe().run(page).response["violations"] == []
        with page.expect_download() as download:
            page.get_by_role("link", name="Daily report: PDF").click()
        assert download.value.suggested_filename == "daily-report-2026-11-26.pdf"
        assert download.value.path().read_bytes().startswith(b"%PDF")
        page.get_by_role("button", name="Day before").click()
        expect(page.get_by_label("Day", exact=True)).to_have_value("2026-11-25")
        page.get_by_label("Day", exact=True).fill("2026-11-20")
        expect(page).to_have_url(f"{address}/#work/2026-11-20")
    assert [call[1].isoformat() for call in yard.calls if call[0] == "work"][-1] == "2026-11-20"


def test_the_ground_in_3d_is_that_of_the_cursor(page: Page, tmp_path: Path) -> None:
    """It is the last that was kept until then: one an hour before noon, one 5 s after it."""
    yard = Yard(ground={"area": [-10.0, -10.0, 10.0, 10.0]})
    yard.receive()
    yard.journals = {"r-1": [event(1, "tree", **SHAPE)]}
    with serving(yard, tmp_path) as address:
        page.goto(f"{address}/#history/r-1/8")
        page.locator("#past_3d").click()
        note = page.locator("#ground_note")
        expect(note).to_contain_text("as it was kept at")
        later = note.inner_text()
        page.locator("#slider").fill("20")
        expect(note).not_to_have_text(later)
        expect(note).to_contain_text("as it was kept at")
        asked = [call[1] for call in yard.calls if call[0] == "ground_at"]
        assert asked == [NOON + timedelta(seconds=8), NOON + timedelta(seconds=2)]
        page.locator("#slider").fill("60")
        expect(note).to_have_text(later)
    assert [call[0] for call in yard.calls if call[0] == "ground"] == [], "the ground of now was not asked for"


def test_what_machines_did_is_on_the_cursor(page: Page, address: str, yard: Yard) -> None:
    """Map, numbers, plots and 3D at the same moment as the tree; a click on a plot goes there."""
    ends = [Event(number=2, stamp=NOON + timedelta(seconds=8), kind="run", node="", text="ended")]
    yard.journals = {"r-1": [event(1, "tree", **SHAPE), *ends]}
    page.goto(f"{address}/#history/r-1/2")
    row = page.locator("#list_motion tr")
    expect(row).to_have_text("zx2002.00, 2.001.001.00swing_joint 0.20, boom_joint -0.50")
    mark = page.locator("#map_box [data-machine=zx200] polygon").first
    drawn = mark.get_attribute("points")
    expect(page.locator("#motion .plot canvas")).to_have_count(3)
    expect(page.locator("#slider")).to_have_attribute("max", "100")  # the machine went on for a while
    page.locator("#slider").fill("60")
    expect(row).to_contain_text("6.00, 2.00")
    expect(mark).not_to_have_attribute("points", drawn or "")
    plot = page.locator("#motion .plot .u-over").first
    box = plot.bounding_box()
    assert box is not None
    plot.click(position={"x": box["width"] / 2, "y": 20})
    expect(row).to_contain_text(re.compile(r"(4\.[89]|5\.[0-2])\d, 2\.00"))
    page.locator("#speed").select_option("16")
    page.locator("#play").click()
    expect(row).to_contain_text("10.00, 2.00")
    page.locator("#past_3d").click()
    expect(page.locator("#space")).to_have_attribute("data-pictures", re.compile(r"[1-9]"))
    with page.expect_download() as download:
        page.locator("#motion a", has_text="CSV").click()
    assert len(Path(download.value.path()).read_text().splitlines()) == 102
    assert Axe().run(page, {"include": [["#motion"]]}).violations_count == 0
    yard.unrecorded = True
    page.reload()
    expect(page.locator("#none_recorded")).to_be_visible()


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


def structural(xml: str, motions: bool = True) -> tuple[list[Reason], list[Reason]]:
    """The check of a tree as far as the tree alone tells."""
    return [error.reason for error in check(xml).errors], []


def test_motions_are_checked_once_nothing_changes(
    page: Page, address: str, yard: Yard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To plan them takes seconds: findings without them come at once."""
    may_end, asked = threading.Event(), list[bool]()

    def slow(xml: str, motions: bool = True) -> tuple[list[Reason], list[Reason]]:
        asked.append(motions)
        return ([Foreign("out of reach")], []) if motions and may_end.wait(60) else structural(xml)

    monkeypatch.setattr(yard, "check_task", slow)
    page.goto(f"{address}/#editor/4")
    findings = page.get_by_role("region", name="Check")
    expect(findings).to_contain_text("The motions of the arms are still being planned.")
    expect(findings).not_to_contain_text("out of reach")
    may_end.set()
    expect(findings).to_contain_text("out of reach")
    expect(findings).not_to_contain_text("planned")
    assert (asked[0], asked[-1]) == (False, True)


DRAWN = """        <Sequence>
            <Action ID="LeafNodeZx200" model_name="zx200" subtask_name="subtask_zx200_change_pose" record_name="pose"/>
            <Action ID="WaitForClick"/>
            <Action ID="LeafNodeZx200" model_name="zx200" subtask_name="subtask_zx200_change_pose" record_name="pose"/>
        </Sequence>
"""


def test_a_task_is_drawn_checked_and_saved(
    page: Page, address: str, yard: Yard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By what is written on the page alone: three leaves, one of them by drag and one by copy and keys."""
    monkeypatch.setattr(yard, "check_task", structural)
    yard.palette = palette(builtin=True)
    page.goto(f"{address}/#tasks")
    page.get_by_role("link", name="Draw a task").click()
    findings = page.get_by_role("region", name="Check")
    expect(findings).to_contain_text("Errors (1)")  # the Sequence is empty
    nodes = page.locator("[data-path]")
    expect(nodes).to_have_text(["Sequence ✖1"])
    page.get_by_text("zx200", exact=True).click()
    page.get_by_role("button", name="subtask_zx200_change_pose", exact=True).click()
    page.get_by_label("record_name").fill("pose")
    page.get_by_label("Filter").fill("click")
    page.get_by_role("button", name="WaitForClick").drag_to(nodes.first)
    drawing = page.get_by_role("application", name="Drawing of the tree")
    drawing.focus()
    for key in ("ArrowLeft", "Control+c", "ArrowRight", "Control+v", "Control+v", "Control+z"):
        page.keyboard.press(key)
    expect(nodes).to_have_count(4)
    expect(findings).to_have_text("Check: nothing to complain of.")
    assert Axe().run(page).response["violations"] == []
    page.get_by_label("Name of the task").fill("dig")
    page.get_by_label("Comment on this version").fill("first")
    page.get_by_role("button", name="Save", exact=True).click()
    expect(page.locator("#message")).to_have_text("Stored as task 5.")
    [(_, stored, description)] = [call for call in yard.calls if call[0] == "add_task"]
    assert description == "dig | first"
    assert DRAWN in str(stored)
    assert check(str(stored)).errors == []


def test_a_leaf_gets_a_new_record_from_its_form(
    page: Page, address: str, yard: Yard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By its fields, and by a place on the map."""
    monkeypatch.setattr(yard, "check_task", structural)
    yard.palette = palette(builtin=True)
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.0))
    page.goto(f"{address}/#editor/new")
    page.get_by_text("ic120", exact=True).first.click()
    page.get_by_role("button", name="st_ic120_navigate_anywhere", exact=True).click()
    form = page.get_by_role("region", name="Chosen node")
    form.get_by_role("button", name="New record", exact=True).first.click()
    made = page.get_by_role("region", name="New record")
    expect(made.get_by_label("Machine")).to_have_value("ic120")
    made.get_by_label("Record").fill("HOME")
    made.get_by_label("Field").fill("x")
    made.get_by_label("Values").fill("1.5")
    made.get_by_role("button", name="Save").click()
    expect(form.get_by_label("record_name", exact=True)).to_have_value("HOME")
    form.get_by_role("button", name="New record from the map").first.click()
    page.locator("#map_box").click()
    place = page.get_by_role("region", name="Make this place a record")
    place.get_by_label("Name of the record").fill("HERE")
    place.get_by_role("button", name="Save").click()
    expect(form.get_by_label("record_name", exact=True)).to_have_value("HERE")
    written = [call for call in yard.calls if call[0] == "set_parameter"]
    assert [call[1:3] for call in written] == [("ic120", "HOME"), ("ic120", "HERE")]
