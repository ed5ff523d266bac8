"""The operator's panel in a real browser."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Browser, expect

NOTE_PRESS = (
    "() => document.getElementById('stop').addEventListener('click', () => { window.pressed = Date.now(); }, true)"
)
LIMIT = 60.0  # s for whatever must happen at all


@dataclass(frozen=True)
class Stopped:
    """A press of the stop button: when the page saw it [s since 1970], s to its answer, receipt, panel's text."""

    at: float
    seconds: float
    receipt: dict[str, Any]
    text: str


class Panel:
    """The page of one task, with its two buttons."""

    def __init__(self, browser: Browser, url: str) -> None:
        expect.set_options(timeout=LIMIT * 1000)
        self._page = browser.new_page(viewport={"width": 1280, "height": 800}, locale="en-GB")
        self._page.set_default_timeout(LIMIT * 1000)
        self._page.goto(url)
        expect(self._page.locator("#state")).to_have_text("Ready to start.")
        self._page.evaluate(NOTE_PRESS)

    def start(self) -> tuple[str, float]:
        """Press the green button and say yes to the machines that will move; the run, and s from there to its begin."""
        self._page.locator("#start").click()
        expect(self._page.locator("#dialog_text")).to_contain_text("zx200")
        begun = time.time()
        with self._page.expect_response(lambda answer: answer.url.endswith("/api/runs")) as told:
            self._page.locator("#dialog_yes").click()
        return str(told.value.json()["run_id"]), time.time() - begun

    def stop(self) -> Stopped:
        """Press the red button and wait for the receipt."""
        with self._page.expect_response(lambda answer: answer.url.endswith("/api/stop")) as told:
            self._page.locator("#stop").click(force=True)  # at once, as a person presses
        (receipt,) = told.value.json()
        answered, pressed = time.time(), float(self._page.evaluate("window.pressed")) / 1000
        expect(self._page.locator("#stop_report")).to_contain_text("zx200: ")
        return Stopped(pressed, answered - pressed, receipt, self._page.locator("#stop_report").inner_text())
