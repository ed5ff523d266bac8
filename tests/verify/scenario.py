"""The verification, in order."""

from __future__ import annotations

from typing import Any

from lxml import etree
from playwright.sync_api import Browser

from verify import registered, runs, stops
from verify.panel import Panel
from verify.place import Place
from verify.report import Book
from verify.sensing import Sensing
from verify.stage import Stage


def play(book: Book, place: Place, browser: Browser) -> None:
    """All parts; the book holds what was measured by then, also when one breaks off."""
    task = registered.register(book, place)
    registered.groot_files(book, place)
    registered.borders(book, place)
    truth = place.truth()
    try:
        with place.node() as ros:
            sensing = Sensing(ros)
            sensing.wait_ready()
            panel = Panel(browser, place.mesh.tms("panel", "--task", str(task), "--url").stdout.strip())
            _runs(Stage(book, place, panel, truth, ros, sensing, task))
    finally:
        truth.close()


def _runs(stage: Stage) -> None:
    leaves = [
        str(node.get("record_name")) for node in etree.parse(registered.FILE).iter("Action") if node.get("record_name")
    ]
    before = _static(stage)
    runs.first(stage)
    runs.success(stage)
    for leaf in leaves[1:]:
        stops.at_leaf(stage, leaf)
    runs.failure(stage)
    runs.cancelled_goal(stage)
    stops.cancelled_run(stage, runs.DIG)
    changed = [name for name, document in before.items() if _static(stage)[name] != document]
    stage.book.check(11, f"{len(changed)} of {len(before)} static records changed by all runs", not changed)


def _static(stage: Stage) -> dict[str, Any]:
    """The documents of all static records."""
    with stage.place.store() as store:
        return {f"{one['model_name']}/{one['record_name']}": one for one in store["parameter"].find({"type": "static"})}
