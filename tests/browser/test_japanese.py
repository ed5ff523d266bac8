"""A run in the Japanese console: no English sentence, and no name of ROS outside `details`."""

import pytest
from playwright.sync_api import Page, expect
from test_console import PAGES, SWINGS, open_page

from browsers import ask
from conftest import Mesh, wait_until
from words import ROS, english

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.browser]
# Texts that a person sees now; a tree shows names that its author has given.
VISIBLE = """() => {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), found = [];
    while (walker.nextNode()) {
        const parent = walker.currentNode.parentElement;
        if (!parent.closest("details, code, pre, script, .treebox") && parent.checkVisibility()) {
            found.push(walker.currentNode.textContent.trim());
        }
    }
    return found.filter((text) => text !== "");
}"""


def foreign(page: Page, address: str) -> list[str]:
    """What is shown in English, or as ROS has it, but for the names that people gave to their tasks."""
    given = {task["description"] for task in ask(address, "/api/tasks")}
    texts = [text for text in page.evaluate(VISIBLE) if not any(name and name in text for name in given)]
    ros = page.locator("#page").get_attribute("data-page") != "data"  # where topics of sensing are what is shown
    return [text for text in texts if english(text) or (ros and ROS.search(text))]


def test_a_run_that_is_stopped(page: Page, address: str, idle: Mesh) -> None:
    open_page(page, address, "board")
    page.locator("#language").click()
    run = ask(address, "/api/runs", {"task_id": SWINGS})["run_id"]
    wait_until(lambda: ask(address, "/api/state")["machines"][0]["state"] == "moving", 60, "zx200 moves")
    for name in ("board", "tree", "map"):
        open_page(page, address, name)
        expect(page.locator("html")).to_have_attribute("lang", "ja")
        assert foreign(page, address) == [], name
    page.get_by_role("button", name="ソフト停止", exact=True).click()
    expect(page.locator("#stop_report")).to_contain_text("zx200")
    wait_until(lambda: not ask(address, "/api/state")["runs"], 60, "the run has ended")
    for name in PAGES:
        open_page(page, address, name)
        expect(page.locator("#page h2").first).to_be_visible()
        assert foreign(page, address) == [], name
    page.goto(f"{address}/#history/{run}")
    expect(page.locator("#list_events tr").first).to_be_visible()
    page.locator("#run_log summary").click()  # whoever opens it sees English
    expect(page.locator("#run_log .log_line").first).to_be_visible()
    assert foreign(page, address) == []
