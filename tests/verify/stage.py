"""What the parts of the scenario share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import browsers
from verify.colours import GREEN, ORANGE, of
from verify.groot import Viewer, listens
from verify.panel import Panel
from verify.place import Place, until
from verify.report import Book
from verify.sensing import Sensing
from verify.truth import MOVING, Truth

if TYPE_CHECKING:
    from tms_ros.node import Ros

LIMIT = 60.0  # s for whatever must happen at all
T = TypeVar("T")
ATTEMPTS = 3
UNDER_WAY = 0.6  # s after which the motion of the leaf before is over


@dataclass(frozen=True)
class Stage:
    """The mesh, the panel of the task, the true motion, a node, and the book of what was measured."""

    book: Book
    place: Place
    panel: Panel
    truth: Truth
    ros: Ros
    sensing: Sensing
    task: int

    @contextmanager
    def watched(self) -> Iterator[tuple[Viewer, str, float]]:
        """A run that begins by the panel's button: Groot's view, its id, s until it had begun."""
        port = self.place.site.file.ports.groot
        until(lambda: not listens(port), LIMIT, "the run before has closed Groot's ports")
        viewer = Viewer(port)
        try:
            run, seconds = self.panel.start()
            yield viewer, run, seconds
            if not viewer.ended(LIMIT):
                raise TimeoutError(f"run {run} does not end in Groot")
            until(lambda: self.outcome(run)["ended_at"], LIMIT, f"run {run} has ended")
        finally:
            viewer.close()

    def works(self, viewer: Viewer, leaf: str) -> bool:
        """Wait until a leaf is orange and moves the machine; False if it was over before, or the run was."""
        if not viewer.wait(leaf, ORANGE, LIMIT):
            return False
        orange = next(change.stamp for change in viewer.changes if change.node == leaf)
        since = orange if leaf == viewer.shape.leaves[0] else orange + UNDER_WAY
        self.truth.wait(lambda now: now.at > since and (now.speed > MOVING or viewer.colour(leaf) != ORANGE), LIMIT)
        return viewer.colour(leaf) == ORANGE

    def while_it_works(self, leaf: str, what: Callable[[str], T]) -> tuple[Viewer, str, T]:
        """Start the task and do something with its run while a leaf works: Groot's view, the run, what came of it.

        A run that fails before, or whose leaf was over meanwhile, is told on the terminal, and begun anew.

        Raises:
            TimeoutError: the leaf never worked.
        """
        for _ in range(ATTEMPTS):
            with self.watched() as (viewer, run, _):
                found = [what(run)] if self.works(viewer, leaf) else []
            if found and GREEN not in of(viewer.changes, leaf):  # it came in time
                return viewer, run, found[0]
            why = self.outcome(run)["reason"] or {"text": {"en": ""}}
            print(f"begun anew, since {leaf} did not work in run {run}: {why['text']['en']}", flush=True)
            if browsers.ask(self.place.address, "/api/state")["machines"][0]["latch"]:
                self.place.arm()
        raise TimeoutError(f"{leaf} does not work")

    def outcome(self, run: str) -> dict[str, Any]:
        """A run of the history."""
        return next(row for row in browsers.ask(self.place.address, "/api/runs") if row["run_id"] == run)

    def events(self, run: str) -> list[dict[str, Any]]:
        """Its journal."""
        found: list[dict[str, Any]] = browsers.ask(self.place.address, f"/api/runs/{run}/events")
        return found
