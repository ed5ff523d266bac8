"""The live tree at field size: it follows the running leaf, what has ended folds, and a node tells more."""

import re
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tms_ur.models import Event
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, serving, shape

pytestmark = [pytest.mark.turns, pytest.mark.browser]
BRANCHES, LEAVES = 27, 9  # 271 nodes, as the largest task of the field has


SHAPE = shape(BRANCHES, LEAVES)
WHOLE = 1 - 1e-5  # of a node in sight: the browser moves a tree by fractions of a pixel, in numbers of seven digits


@pytest.fixture
def yard() -> Yard:
    yard = Yard()
    yard.receive()
    yard.journals = {"r-1": [Event(number=1, stamp=NOON, kind="tree", node="", text="", values={**SHAPE})]}
    return yard


@pytest.fixture
def address(yard: Yard, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


def work(yard: Yard, leaf: str) -> None:
    """All before it have ended, and it works."""
    at = SHAPE["paths"].index(leaf)
    on = {"0", leaf, leaf.rpartition(".")[0]}
    states = "".join("1" if p in on else "2" if i < at else "0" for i, p in enumerate(SHAPE["paths"]))
    yard.board.put_runs([RUN.model_copy(update={"leaf": leaf, "nodes": states})])


def test_a_large_tree_follows_its_run(page: Page, address: str, yard: Yard) -> None:
    work(yard, "0.3.2")
    page.goto(f"{address}/#tree")
    box = page.locator("#tree_box")
    leaf = box.locator("[data-path='0.3.2']")
    expect(leaf).to_be_in_viewport(ratio=WHOLE)
    expect(leaf).to_have_attribute("data-state", "running")
    expect(leaf).to_contain_text("zx200: dig R0.3.2")
    work(yard, "0.25.8")
    leaf = box.locator("[data-path='0.25.8']")
    expect(leaf).to_be_in_viewport(ratio=WHOLE)
    size = leaf.bounding_box()
    assert size and size["height"] >= 20  # px, legible
    expect(box.locator("[data-path='0.3.2']")).to_have_count(0)  # its branch has folded


def test_a_node_that_is_clicked_on_opens_and_tells_more(page: Page, address: str, yard: Yard) -> None:
    work(yard, "0.3.2")
    page.goto(f"{address}/#tree")
    expect(page.locator("[data-path='0.3.2']")).to_be_in_viewport(ratio=WHOLE)
    page.locator("[data-path='0.3.2']").click()
    details = page.locator("#node_details")
    expect(details).to_contain_text("R0.3.2")
    expect(details).to_contain_text("Running")
    expect(details).to_contain_text("Tries (0)")
    expect(details.get_by_text("Blackboard (2)")).to_be_visible()
    expect(page.locator("#node_blackboard dl")).to_be_hidden()  # it names no key itself
    details.get_by_text("Blackboard (2)").click()
    expect(page.locator("#node_blackboard dl")).to_contain_text('target"R7"')
    page.get_by_role("button", name="Fit").click()
    branch = page.locator("[data-path='0.4']")
    expect(branch).to_contain_text(f"(+{LEAVES})")
    branch.click()
    expect(branch).not_to_contain_text("(+")
    expect(page.locator("[data-path='0.4.0']")).to_have_count(1)


def test_a_node_is_searched_for_and_durations_are_shown(page: Page, address: str, yard: Yard) -> None:
    work(yard, "0.3.2")
    began = Event(number=2, stamp=NOON, kind="node", node="0.3.2", text="dig IDLE -> RUNNING")
    ended = Event(number=3, stamp=NOON + timedelta(seconds=7), kind="node", node="0.3.2", text="dig RUNNING -> SUCCESS")
    yard.journals["r-1"] += [began, ended]
    page.goto(f"{address}/#tree")
    leaf = page.locator("[data-path='0.3.2']")
    expect(leaf).to_be_in_viewport(ratio=WHOLE)
    page.get_by_role("button", name="Durations").click()
    expect(leaf.locator(".node_mark")).to_have_text("7.0 s")
    search = page.get_by_role("searchbox", name="Search")
    search.fill("r0.20.7")
    expect(page.get_by_text("0 of 1")).to_be_visible()
    search.press("Enter")
    sought = page.locator("[data-path='0.20.7']")  # in a branch that is folded
    expect(sought).to_be_in_viewport(ratio=WHOLE)
    expect(sought).to_have_class(re.compile("found"))
    expect(page.locator("#node_details")).to_contain_text("R0.20.7")
    expect(page.get_by_text("1 of 1")).to_be_visible()
    page.goto(f"{address}/#history/r-1/3")
    expect(page.locator("#past_title")).to_be_visible()
    page.get_by_role("button", name="Durations").click()
    search.fill("r0.3.2")
    search.press("Enter")
    expect(leaf.locator(".node_mark")).to_have_text("3.0 s")  # until the cursor
