"""The board: one light for the site, what needs a person, starts that ask once; in both languages, and on a phone."""

from collections.abc import Iterator
from datetime import datetime, timezone
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_config.clock import utc_now
from tms_db.reasons import NoStore, StoreDown
from tms_decision.reasons import ProcessAway, SoftwareStop
from tms_reason.errors import DbError
from tms_ur.models import Event, Host, LastStop, Load, Machine, Process, Run
from tms_ur.place_models import PlaceRequest, SharedPlace, SharedPlaces
from tms_ur.reason_view import of_line, view
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, serving, shape

pytestmark = [pytest.mark.turns, pytest.mark.browser]
XML = "<root><Sequence><L model_name='ic120'/><L model_name='zx200'/></Sequence></root>"


class Waiting(Yard):
    """One run was interrupted, and the task moves both machines."""

    def task(self, task_id: int) -> object:  # type: ignore[override]
        return super().task(task_id).model_copy(update={"xml": XML})

    def runs(self, limit: int) -> list[Run]:
        if self.error is not None:
            raise self.error
        facts = {"run_id": "r-9", "task_id": 4, "description": "", "machines": ["zx200"], "started_at": NOON}
        open_ = not any(call[0] in ("start_run", "abandon_run") for call in self.calls)
        return [Run(**facts, state="interrupted", reason=of_line("lost"), ended_at=NOON)] if open_ else []


@pytest.fixture
def yard() -> Waiting:
    yard = Waiting()
    yard.receive()
    yard.board.put_runs([])
    return yard


@pytest.fixture
def address(yard: Waiting, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


def test_a_start_names_the_machines_and_asks_once(page: Page, address: str, yard: Waiting) -> None:
    page.goto(f"{address}/#board")
    run = page.get_by_role("button", name="Run task 4")
    run.click()
    expect(page.locator("#will_move li")).to_have_text(["ic120", "zx200"])
    page.get_by_role("button", name="Back").click()
    run.click()
    assert not any(call[0] == "start_run" for call in yard.calls)
    page.get_by_role("button", name="Do it").click()
    expect(page.locator("#message")).to_have_text("Run r-2 has begun.")
    assert [call for call in yard.calls if call[0] == "start_run"] == [("start_run", 4, False)]


@pytest.mark.parametrize(("word", "call"), [("Resume", "start_run"), ("Give up", "abandon_run")])
def test_an_interrupted_run_is_closed_by_a_person(
    page: Page, address: str, yard: Waiting, word: str, call: str
) -> None:
    page.goto(f"{address}/#board")
    expect(page.locator("#light")).to_contain_text("Needs a look")
    rows = page.locator("#list_interrupted li")
    expect(rows).to_contain_text("Interrupted")
    page.get_by_role("button", name=f"{word} run r-9").click()
    expect(page.locator("#dialog_text")).to_contain_text(word)
    page.get_by_role("button", name="Do it").click()
    expect(rows).to_have_count(0)
    expect(page.locator("#light")).to_contain_text("All armed")
    assert [one[-1] for one in yard.calls if one[0] == call] == ["r-9"]


def test_the_light_and_the_card_tell_what_is(page: Page, address: str, yard: Waiting) -> None:
    yard.abandon_run("r-9")
    light, card = page.locator("#light"), page.locator("[data-machine=zx200]")
    page.goto(f"{address}/#board")
    expect(light).to_have_text("● All armed ")
    expect(card.get_by_role("button", name="Re-arm zx200")).to_have_count(0)
    yard.board.put_machine(Machine(name="zx200", state="moving", joint_age=0.1))
    expect(light).to_have_text("▶ Moving zx200")
    expect(card.locator("[data-part=load]")).to_have_count(0)
    yard.board.put_load("zx200", Load(mass=1280.0, loose=0.7, capacity=0.92, measured=False))
    expect(card.locator("[data-part=load]")).to_contain_text("about 0.70 of 0.92 m³, 1.28 t (estimated)")
    yard.board.put_stop("zx200", LastStop(stamp=datetime(2026, 1, 31, 9, 5, tzinfo=timezone.utc), confirmed=True))
    yard.receive(latch=view(SoftwareStop()))
    yard.board.put_runs([])
    expect(light).to_have_text("⬣ Stopped zx200, ic120")
    expect(card).to_contain_text("Stopped because: software stop (since ")
    expect(card).to_contain_text("Seen to stand 31 Jan")
    expect(card.get_by_role("button", name="Re-arm zx200")).to_be_visible()
    page.locator("#language").click()
    expect(light).to_contain_text("停止中")
    expect(card).to_contain_text("に静止を確認")


def test_a_process_that_cannot_be_kept_up_is_an_alarm(page: Page, address: str, yard: Waiting) -> None:
    rows = [Process(name="tms:db", state="FATAL"), Process(name="zx200:st_swing", state="STOPPED")]
    yard.board.put_host(Host(name="pc", processes=rows))
    page.goto(f"{address}/#board")
    alarms, light = page.locator("#list_alarms li"), page.locator("#light")
    expect(alarms).to_contain_text(["⬣ Critical process tms:db ends again and again"])
    expect(light).to_contain_text("Needs a look")
    yard.now += 7
    yard.receive()
    yard.board.snapshot()
    expect(alarms).to_have_count(0)
    yard.now += 15
    yard.receive()
    expect(alarms).to_contain_text(["⬣ Critical PC pc says nothing"])


def test_an_alarm_offers_what_helps(page: Page, address: str, yard: Waiting) -> None:
    """And it says how urgent it is in more than colour."""
    yard.receive(latch=view(SoftwareStop()))
    yard.board.snapshot()
    yard.now += 600
    yard.receive(latch=view(SoftwareStop()))
    page.goto(f"{address}/#board")
    alarm = page.locator("#list_alarms li").filter(has_text="ic120")
    expect(alarm).to_contain_text("▲ Warning ic120 has been stopped for long")
    alarm.get_by_role("button", name="Look at the machine, then re-arm it").click()
    page.get_by_role("button", name="Do it").click()
    expect(page.locator("#message")).to_contain_text("ic120")
    assert [call[1] for call in yard.calls if call[0] == "rearm"] == ["ic120", "ic120"]


def test_a_shared_place_is_taken_from_its_holder(page: Page, address: str, yard: Waiting) -> None:
    facts = {"run": "", "since": NOON}
    waits = PlaceRequest(machine="ic120", **facts)
    held = SharedPlace(name="ramp", state="held", holder="zx200", queue=[waits], reason=None, **facts)
    yard.board.put_shared(SharedPlaces(places=[held]))
    page.goto(f"{address}/#board")
    row = page.locator("[data-place=ramp]")
    expect(row).to_contain_text("zx200 (since 31 Jan")
    expect(row).to_contain_text("ic120 waits since 31 Jan")
    row.get_by_role("button", name="Take ramp from its holder").click()
    page.get_by_role("button", name="Do it").click()
    expect(page.locator("#message")).to_have_text("ramp: taken from zx200")
    assert ("revoke", "ramp") in [call[:2] for call in yard.calls]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_on_a_phone_everything_is_in_reach(page: Page, address: str, yard: Waiting, scheme: str) -> None:
    page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
    page.set_viewport_size({"width": 390, "height": 844})
    yard.receive(latch=view(SoftwareStop()))
    yard.board.put_host(Host(name="pc", processes=[Process(name="tms:db", state="FATAL")]))
    page.goto(f"{address}/#board")
    expect(page.locator("#list_interrupted li")).to_be_visible()
    for name in ("Run task 4", "Re-arm zx200", "Resume run r-9", "Software stop"):
        box = page.get_by_role("button", name=name, exact=True).bounding_box()
        assert box and box["x"] >= 0 and box["x"] + box["width"] <= 390, name
        assert box["height"] >= 44, name
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()


def test_a_process_is_whole_on_a_phone(page: Page, address: str, yard: Yard) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    name = "zx200:subtask_zx200_excavate_simple_plan"
    rows = [Process(name=name, state="RUNNING", pid=7, uptime=65.0, cpu=3.0, memory=90_000_000)]
    yard.board.put_host(Host(name="site-pc-1", processes=rows))
    page.goto(f"{address}/#system")
    row = page.locator(f"[data-process='{name}']")
    expect(row).to_contain_text("Running")
    for part in (row.get_by_text("Running"), row.get_by_role("button").first, row.get_by_role("button").last):
        box = part.bounding_box()
        assert box and box["x"] >= 0 and box["x"] + box["width"] <= 390
    table = page.get_by_role("region", name="Always running")
    assert table.evaluate("it => it.scrollWidth <= it.clientWidth"), "nothing is to be scrolled sideways"
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert "CPU" in row.evaluate("it => [...it.cells].map((one) => getComputedStyle(one, '::before').content).join()")
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()


def test_a_run_that_waits_for_its_process_moves_nothing_below_it(page: Page, address: str, yard: Yard) -> None:
    """Its reason has an action; a finger is over the tasks."""
    yard.board.put_runs([])
    page.goto(f"{address}/#board")
    tasks = page.locator("#list_tasks")
    expect(tasks.locator("li").first).to_be_visible()
    place = tasks.bounding_box()
    reason = view(ProcessAway("zx200:subtask_zx200_change_pose"))
    yard.board.put_runs([RUN.model_copy(update={"reason": reason, "reason_since": utc_now()})])
    expect(page.locator("#list_active")).to_contain_text("is not there")
    assert tasks.bounding_box() == place


def test_what_is_not_known_while_the_database_is_away_is_said(page: Page, address: str, yard: Waiting) -> None:
    """No interrupted run is shown then: that must not look as if there were none."""
    yard.error = DbError(StoreDown(NoStore()))
    page.goto(f"{address}/#board")
    problem = page.locator("#interrupted_problem")
    expect(problem).to_contain_text("Whether runs were interrupted is not known: the store does not answer")
    expect(problem.get_by_role("link", name="Start it, or the MongoDB of the site")).to_be_visible()
    expect(page.locator("#light")).to_contain_text("Needs a look")
    page.locator("#language").click()
    expect(problem).to_contain_text("中断された実行があるか分かりません: ストアが応答しません")
    yard.error = None
    expect(page.locator("#list_interrupted li")).to_be_visible()  # it asks again by itself
    expect(problem).to_be_empty()


def test_a_tree_that_cannot_be_read_is_told(page: Page, address: str, yard: Waiting) -> None:
    yard.error = DbError(StoreDown(NoStore()))
    yard.board.put_runs([RUN])
    page.goto(f"{address}/#tree")
    expect(page.locator("#tree_problem")).to_contain_text("The tree cannot be read: the store does not answer")
    yard.error = None
    expect(page.locator("[data-path='0']")).to_be_visible()
    expect(page.locator("#tree_problem")).to_have_count(0)


def test_a_machine_is_given_back_from_its_card(page: Page, address: str, yard: Waiting) -> None:
    yard.board.put_machine(Machine(name="zx200", state="standing", joint_age=0.1, by_hand="mina"))
    page.goto(f"{address}/#board")
    card = page.locator("[data-machine=zx200]")
    expect(card).to_contain_text("mina drives by hand")
    card.get_by_role("button", name="Give back zx200").click()
    expect(page.locator("#dialog_text")).to_contain_text("Have you made sure that nobody drives it")
    page.get_by_role("button", name="Back", exact=True).click()
    assert not any(call[0] == "give_back" for call in yard.calls)
    card.get_by_role("button", name="Give back zx200").click()
    page.get_by_role("button", name="Do it").click()
    expect(page.locator("#message")).to_contain_text("zx200 is given back. zx200: seen to stand after 0.4 s")
    assert [call[1] for call in yard.calls if call[0] == "give_back"] == ["zx200"]


def test_a_wait_is_told_with_its_own_begin_and_what_helps(
    page: Page, address: str, yard: Waiting, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On the card, and in the details of the leaf that waits."""
    yard.journals = {"r-1": [Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**shape(1, 2)})]}
    reason = view(ProcessAway("zx200:subtask_zx200_change_pose"))
    waiting = RUN.model_copy(update={"reason": reason, "leaf": "0.0.1", "nodes": "1101"})
    with monkeypatch.context() as then:
        then.setattr("tms_ur.board.utc_now", lambda: NOON)
        yard.board.put_runs([waiting])
    yard.board.put_runs([waiting])
    page.goto(f"{address}/#board")
    card = page.locator("[data-machine=zx200]")
    expect(card).to_contain_text("is not there (since 31 Jan")  # and not since the machine stands
    link = card.get_by_role("link", name="Read the log of the process")
    expect(link).to_have_attribute("href", "#system/zx200%3Asubtask_zx200_change_pose")
    page.goto(f"{address}/#tree")
    page.locator("[data-path='0.0.1']").click()
    waits = page.locator("#node_waits")
    expect(waits).to_contain_text("is not there (since 31 Jan")
    expect(waits.get_by_role("link")).to_be_visible()
    yard.error = DbError(StoreDown(NoStore()))
    expect(page.locator("#node_record")).to_contain_text("Record R0.0.1: the store does not answer")
    expect(page.locator("#node_blackboard")).to_contain_text("the store does not answer")


def test_the_journal_of_a_run_says_what_helps(page: Page, address: str, yard: Waiting) -> None:
    """In its table, and at each try of a node that has failed."""
    why = view(ProcessAway("tms:db"))
    tree = Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**shape(1, 2)})
    states = [("IDLE -> RUNNING", None), ("RUNNING -> FAILURE", why)]
    moves = [
        Event(number=2 + index, stamp=NOON, kind="node", node="0.0.1", text=f"dig {text}", reason=reason)
        for index, (text, reason) in enumerate(states)
    ]
    yard.journals = {"r-9": [tree, *moves]}
    page.goto(f"{address}/#history/r-9")
    link = page.locator("#list_events").get_by_role("link", name="Read the log of the process")
    expect(link).to_have_attribute("href", "#system/tms%3Adb")
