"""Pages at which things happen: without a fault of accessibility, and as wide as a phone."""

from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_config.clock import utc_now
from tms_decision.reasons import SoftwareStop
from tms_ts.bt import palette
from tms_ur.models import Event, Host, Joint, Place, Process, Question
from tms_ur.reason_view import view
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, log_line, serving, shape

pytestmark = [pytest.mark.turns, pytest.mark.browser]
PHONE = 390  # px
TREE = shape(3, 2)
# The address of a page, what is clicked on there, and what shows that it is there with its news.
PLACES = {
    "board": ([], "#list_active li"),
    "tree": (["[data-path='0.1']"], "#node_details"),
    "map": (["#map_box"], "#place_form"),
    "history/r-1": ([], "#past [data-path]"),
    "editor/new": (["[data-path='0']"], "#ed_form"),
    "data": (["[aria-label^='History of']"], "#list_records tr"),
    "tasks": ([], "#list_stored tr"),
    "system": ([], "#list_on_demand tr"),
    "system/machine/zx200": ([], "#log"),
    "work": ([], "#list_work tr"),
    "components": ([], "#page [data-path='0.3']"),
}


class Busy(Yard):
    """Everything at once: a run, a question, a stopped machine, a process that is down."""

    def happen(self) -> None:
        self.receive(joints=[Joint(name="swing_joint", position=0.4, velocity=0.1)])
        self.receive(latch=view(SoftwareStop()), lamp="stopped")
        asked = Question(id="q", run_id="r-1", node="0", title="Safety", text="Clear?",
                         until=utc_now() + timedelta(seconds=90))  # fmt: skip
        states = "".join("1" if path in ("0", "0.1", "0.1.0") else "2" for path in TREE["paths"])
        self.board.put_runs([RUN.model_copy(update={"leaf": "0.1.0", "nodes": states})], [asked])
        self.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.5))
        rows = [("tms:db", "FATAL", False), ("zx200:rc", "RUNNING", False), ("zx200:st", "RUNNING", True)]
        processes = [Process(name=name, state=state, on_demand=later) for name, state, later in rows]
        self.board.put_host(Host(name="pc", processes=processes))

    def log(self, process: str, size: int) -> str:
        return "".join(log_line(second, level) for second, level in enumerate(("INFO", "WARNING", "ERROR")))


@pytest.fixture
def yard() -> Busy:
    yard = Busy()
    yard.palette = palette(builtin=True)
    tree = Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**TREE})
    change = Event(number=2, stamp=NOON + timedelta(seconds=3), kind="node", node="0.1", text="x IDLE -> RUNNING")
    yard.journals = {"r-1": [tree, change]}
    yard.happen()
    return yard


@pytest.fixture
def address(yard: Busy, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


@pytest.mark.parametrize("place", PLACES)
def test_a_page_where_things_happen(page: Page, address: str, yard: Busy, place: str) -> None:
    """As wide as a phone, then on a large screen in the dark; axe has nothing to say to either."""
    clicks, shown = PLACES[place]
    page.set_viewport_size({"width": PHONE, "height": 844})
    page.goto(f"{address}/#{place}")
    for selector in clicks:
        page.locator(selector).first.click()
    expect(page.locator(shown).first).to_be_visible()
    yard.happen()
    expect(page.locator("#questions .question")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE
    assert Axe().run(page).response["violations"] == []
    page.set_viewport_size({"width": 1920, "height": 1080})
    page.emulate_media(color_scheme="dark")
    assert Axe().run(page).response["violations"] == []
