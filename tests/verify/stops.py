"""Runs that are ended from outside: cancelled, and stopped from the panel at each leaf."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import browsers
from verify import colours, history
from verify.stage import Stage
from verify.truth import STILL, Sample, stood, travel

if TYPE_CHECKING:
    from verify.groot import Viewer

WATCHED = 1.0  # s for which the machine is watched after a receipt
CREPT = 0.005  # rad that a joint may go in that time: the arm settles
SOON = 5.0  # s from a press until the machine stands: the swing's dead time and lag at full speed take 4 s
TOLD = 0.5  # s that the receipt's time may be shorter than the true one


def cancelled_run(stage: Stage, leaf: str) -> None:
    """A cancel of the run, as `tms cancel` and the console ask for it."""

    def cancel(run: str) -> float:
        begun = time.time()
        browsers.ask(stage.place.address, f"/api/runs/{run}/cancel", {})
        return begun

    viewer, run, begun = stage.while_it_works(leaf, cancel)
    wrong, state = _wrong(stage, viewer, run, leaf)
    after = _watch(stage, time.time())
    told = f"cancel at {leaf}: all nodes grey {_ms(history.halted_within(stage.events(run)))} after the root's decision"
    stage.book.note(10, f"{told}, {_truth(stage.truth.since(begun))}; outcome {state}", [*wrong, *_moved(after)])
    stage.book.note(9, f"run cancelled: {leaf} was RUNNING, then IDLE; outcome {state}", wrong)
    stage.book.check(8, f"cancel of a working goal: {len(_goals_cancelled(stage, run))} goal ended", not wrong)


def at_leaf(stage: Stage, leaf: str) -> str:
    """The panel's red button while a leaf works; the run."""
    viewer, run, pressed = stage.while_it_works(leaf, lambda _: stage.panel.stop())
    after = _watch(stage, time.time())
    wrong, _ = _wrong(stage, viewer, run, leaf)
    receipt = pressed.receipt
    truly = stood(stage.truth.since(pressed.at))
    seconds = float("inf") if truly is None else truly - pressed.at
    wrong += [] if receipt["confirmed"] else [f"{leaf}: the receipt is not confirmed"]
    wrong += [] if seconds < SOON else [f"{leaf}: stood after {seconds:.2f} s"]
    wrong += [] if seconds < receipt["seconds"] + TOLD else [f"{leaf}: confirmed before it stood"]
    grey = _ms(history.halted_within(stage.events(run)))
    told = f"stop at {leaf}: all nodes grey in {grey}, confirmed after {receipt['seconds']:.2f} s"
    stage.book.note(10, f"{told}, truly stood after {seconds:.2f} s, then {_way(after)}", [*wrong, *_moved(after)])
    stage.book.check(6, f"stop button at {leaf}: receipt after {pressed.seconds:.2f} s", bool(pressed.text))
    stage.place.arm()
    return run


def _wrong(stage: Stage, viewer: Viewer, run: str, leaf: str) -> tuple[list[str], str]:
    """What is wrong with the end of a run, and its outcome."""
    state = str(stage.outcome(run)["state"])
    wrong = colours.wrong_of_halt(viewer.changes, viewer.shape, leaf) + history.wrong_of_cancel(stage.events(run))
    return [f"{leaf}: {one}" for one in wrong] + ([] if state == "cancelled" else [f"{leaf}: outcome {state}"]), state


def _goals_cancelled(stage: Stage, run: str) -> list[history.Event]:
    return [event for event in history.ending(stage.events(run)) if event["kind"] == "goal"]


def _watch(stage: Stage, since: float) -> list[Sample]:
    """The machine for a while after a stop."""
    stage.truth.wait(lambda now: now.at > since + WATCHED, 10 * WATCHED)
    return stage.truth.since(since)


def _moved(samples: Sequence[Sample]) -> list[str]:
    fast = max(sample.speed for sample in samples)
    still = fast < STILL and travel(samples) < CREPT
    return [] if still else [f"it moved after the stop: {fast:.3f} rad/s, {travel(samples):.4f} rad"]


def _truth(samples: Sequence[Sample]) -> str:
    at = stood(samples)
    return "truly still moving" if at is None else f"truly stood after {at - samples[0].at:.2f} s"


def _way(samples: Sequence[Sample]) -> str:
    return f"{travel(samples) * 1000:.1f} mrad in {samples[-1].at - samples[0].at:.1f} s"


def _ms(seconds: float) -> str:
    return f"{seconds * 1000:.0f} ms"
