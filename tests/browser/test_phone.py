"""On a phone every button of a table is on the screen: a row is a block there."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_ur.models import Event, Run, Task
from unit.tms_ur.fakes import NOON
from yard import Yard, serving

pytestmark = [pytest.mark.turns, pytest.mark.browser]
WIDTH = 390  # px
TARGET = 44  # px
RUNS = 12  # more than a screen shows


class Full(Yard):
    """Two versions of a task, and many runs."""

    def tasks(self) -> list[Task]:
        facts = {"model_name": "zx200", "added_at": NOON}
        names = ("dig the pit beside the ramp | first", "dig the pit beside the ramp | second, with a longer reach")
        return [Task(id=number, description=name, **facts) for number, name in enumerate(names, 4)]

    def runs(self, limit: int) -> list[Run]:
        (run,) = super(Yard, self).runs(limit)
        machines = ["zx200", "ic120"]
        return [run.model_copy(update={"run_id": f"r-{number}", "machines": machines}) for number in range(1, RUNS + 1)]


@pytest.fixture
def yard() -> Full:
    yard = Full()
    yard.receive()
    yard.journals = {"r-1": [Event(number=1, stamp=NOON, kind="run", node="", text="running")]}
    return yard


@pytest.fixture
def address(yard: Full, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


@pytest.mark.parametrize(
    ("place", "table", "buttons", "figure"),
    [
        ("tasks", "#list_stored", ("Start task 5", "Download task 5", "Remove task 5"), "Stored at"),
        ("history", "#list_history", ("Show run r-1",), "Duration"),
        ("data", "#list_records", ("Edit zx200/pose", "History of zx200/pose"), "Source"),
    ],
)
def test_buttons_of_rows_are_in_reach(
    page: Page, address: str, place: str, table: str, buttons: tuple[str, ...], figure: str
) -> None:
    """Nothing is scrolled sideways, and the figures have their names."""
    page.set_viewport_size({"width": WIDTH, "height": 844})
    page.goto(f"{address}/#{place}")
    row = page.locator(f"{table} tr").first
    expect(row).to_be_visible()
    for name in buttons:
        box = row.get_by_role("button", name=name, exact=True).bounding_box()
        assert box and box["x"] >= 0 and box["x"] + box["width"] <= WIDTH, name
        assert box["height"] >= TARGET, name
    region = page.locator(f".scroll:has({table})")
    assert region.evaluate("it => it.scrollWidth <= it.clientWidth"), "nothing is to be scrolled sideways"
    assert page.evaluate("document.documentElement.scrollWidth") <= WIDTH
    names = row.evaluate("it => [...it.cells].map((one) => getComputedStyle(one, '::before').content).join()")
    assert figure in names
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()


def test_a_run_that_is_shown_is_gone_to(page: Page, address: str) -> None:
    """The list of runs is longer than the screen."""
    page.set_viewport_size({"width": WIDTH, "height": 500})
    page.goto(f"{address}/#history")
    show = page.get_by_role("button", name="Show run r-1", exact=True)
    expect(page.locator("#past_title")).to_have_count(0)
    show.click()
    expect(page.locator("#past_title")).to_be_in_viewport(ratio=1)
    page.evaluate("scrollTo(0, 0)")
    show.click()  # of the one that is there already
    expect(page.locator("#past_title")).to_be_in_viewport(ratio=1)
