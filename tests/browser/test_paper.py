"""What comes out of a printer: black on white, nothing to press, tables whole, pictures as wide as the page."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tms_ur.models import Event, Host, Place, Process
from unit.tms_ur.fakes import NOON
from yard import Yard, serving, shape

pytestmark = [pytest.mark.turns, pytest.mark.browser]
SHEET = {"width": 700, "height": 1000}  # px, about A4 without margins
PRESSED = "button, input, select, a.button, nav, #stop"
PRINT = "dispatchEvent(new Event('beforeprint'))"  # as a browser does before it takes the page
LONG = 60  # rows, more than a page of paper holds


@pytest.fixture
def yard() -> Yard:
    yard = Yard(ground={"area": [-10.0, -10.0, 10.0, 10.0], "plan": {"bank": 16.0, "loads": 4}})
    yard.receive()
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.5))
    rows = [Process(name=f"zx200:st_{number}", state="RUNNING", pid=7) for number in range(LONG)]
    yard.board.put_host(Host(name="pc", processes=rows))
    yard.journals = {"r-1": [Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**shape(3, 2)})]}
    return yard


@pytest.fixture
def address(yard: Yard, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


def pages(pdf: bytes) -> int:
    return len(re.findall(rb"/Type\s*/Page\b", pdf))


def on_paper(page: Page) -> None:
    page.evaluate(PRINT)
    page.set_viewport_size(SHEET)  # type: ignore[arg-type]
    page.emulate_media(media="print", color_scheme="dark")


def test_a_print_is_black_on_white_with_nothing_to_press(page: Page, address: str) -> None:
    """Of each page, also of a browser in the dark; the site, the page and the time are at its top."""
    for name, title, shown in (
        ("board", "Board", "#list_machines .card"),
        ("system", "System", "#list_processes tr"),
        ("history/r-1", "History", "#past [data-path]"),
        ("data", "Data", "#list_records tr"),
        ("work/2026-11-26", "Work", "#list_work tr"),
        ("tasks", "Tasks", "#list_stored tr"),
    ):
        page.emulate_media(media="screen", color_scheme="dark")
        page.set_viewport_size({"width": 1280, "height": 800})
        page.goto(f"{address}/#{name}")
        expect(page.locator(shown).first).to_be_visible()
        on_paper(page)
        expect(page.locator(f":is({PRESSED}):not(.plain_time):visible")).to_have_count(0)
        expect(page.locator("#where strong")).to_have_text("test")
        expect(page.locator("#paper_head")).to_have_text(re.compile(rf"^{title}, \d\d/\d\d/\d{{4}}, \d\d:\d\d:\d\d$"))
        assert page.evaluate("getComputedStyle(document.body).color") == "rgb(0, 0, 0)", name
        assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)", name
        assert page.evaluate("document.documentElement.scrollWidth") <= SHEET["width"], name


def test_a_long_table_is_whole_over_pages(page: Page, address: str) -> None:
    page.goto(f"{address}/#system")
    expect(page.locator("#list_processes tr")).to_have_count(LONG)
    assert pages(page.pdf(format="A4")) >= 2
    on_paper(page)
    table = page.get_by_role("region", name="Always running")
    assert table.evaluate("it => getComputedStyle(it).overflowX") == "visible"
    assert table.evaluate("it => getComputedStyle(it.querySelector('thead')).display") == "table-header-group"
    assert table.evaluate("it => getComputedStyle(it.querySelector('tbody tr')).breakInside") == "avoid"


@pytest.mark.parametrize(
    ("place", "shown", "picture"),
    [("map", "#map_box [data-machine=ic120]", "#map_box"), ("history/r-1", "#past [data-path]", "#tree_box")],
)
def test_a_picture_is_as_wide_as_the_page(page: Page, address: str, place: str, shown: str, picture: str) -> None:
    """All of what the screen shows of it, smaller."""
    page.set_viewport_size({"width": 1600, "height": 900})
    page.goto(f"{address}/#{place}")
    expect(page.locator(shown).first).to_be_visible()
    before = page.locator(picture).bounding_box()
    on_paper(page)
    after = page.locator(picture).bounding_box()
    assert before and after and before["width"] > SHEET["width"]
    assert after["x"] >= 0 and after["x"] + after["width"] <= SHEET["width"]
    assert after["width"] > 0.9 * SHEET["width"]
    assert after["width"] / after["height"] == pytest.approx(before["width"] / before["height"], rel=0.05)
    assert pages(page.pdf(format="A4")) >= 1
