"""What a newcomer does by what is written on the pages alone: draw, check, run, stop, find out why, re-arm."""

import re

import pytest
from playwright.sync_api import Page, expect

from conftest import Mesh

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.browser]
LEAVES = ("swing_left", "swing_right") * 4  # on a full PC, pages take their time: the stop must come before the end


def go_to(page: Page, name: str) -> None:
    page.get_by_role("navigation", name="Pages").get_by_role("link", name=name, exact=True).click()


def agree(page: Page) -> None:
    page.get_by_role("dialog").get_by_role("button", name="Do it").click()


def draw(page: Page) -> None:
    """Leaves, one after another, each with its record."""
    page.get_by_role("link", name="Draw a task").click()
    page.get_by_text("zx200", exact=True).click()
    for record in LEAVES:
        page.get_by_role("button", name="subtask_zx200_change_pose", exact=True).click()
        expect(page.get_by_label("record_name", exact=True)).to_have_value("")
        page.get_by_label("record_name", exact=True).fill(record)
        page.keyboard.press("Enter")
    expect(page.get_by_text("Check: nothing to complain of.")).to_be_visible()
    page.get_by_label("Name of the task").fill("swings to and fro")
    page.get_by_role("button", name="Save", exact=True).click()
    expect(page.get_by_text(re.compile(r"^Stored as task \d+\.$"))).to_be_visible()


def test_a_newcomer_draws_runs_stops_and_learns_why(page: Page, address: str, idle: Mesh) -> None:
    page.goto(address)
    go_to(page, "Tasks")
    draw(page)
    go_to(page, "Tasks")
    row = page.get_by_role("row", name="swings to and fro")
    row.get_by_role("button", name="Start task").click()
    expect(page.get_by_role("dialog")).to_contain_text("zx200")  # that will move
    agree(page)
    go_to(page, "Tree")
    running = page.get_by_label(re.compile("LeafNodeZx200.*: Running"))
    expect(running).to_be_visible()
    page.get_by_role("button", name="Software stop", exact=True).click()
    expect(page.get_by_text("zx200: seen to stand after")).to_be_visible()
    go_to(page, "Board")
    expect(page.get_by_text("Stopped because: software stop by local").first).to_be_visible()
    page.get_by_role("button", name="Re-arm zx200").click()
    expect(page.get_by_role("dialog")).to_contain_text("software stop by local")
    agree(page)
    expect(page.get_by_text("zx200 is armed.")).to_be_visible()
    go_to(page, "History")
    page.get_by_role("row", name="swings to and fro").first.get_by_role("button", name="Show run").click()
    expect(page.get_by_text(re.compile("zx200 stood .*software stop by local")).first).to_be_visible()
