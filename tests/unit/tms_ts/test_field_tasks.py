"""Real task trees against stub subtasks: the goals and writes that the C++ library made with them.

Where that ended in an exception or never came back, the tree must run as its author meant it, and stop at once.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tms_ts.bt import SUCCESS, Status, TickError, Tree, TreeError, check, load
from unit.tms_ts.fakes import FakeWorld

DATA = Path(__file__).resolve().parents[2] / "data" / "field_tasks"
RECORDINGS = [json.loads(line) for line in (DATA / "expected.jsonl").read_text(encoding="utf-8").splitlines()]
DEFECTS = ("EXCEPTION", "DIVERGED")


def expected(recording: dict[str, Any]) -> dict[str, Any]:
    """`extended` is for files that need node types the C++ scheduler no longer registers."""
    found: dict[str, Any] = recording.get("extended", recording["strict"])
    return found


def by(final: str) -> list[Any]:
    return [
        pytest.param(r["file"], expected(r), id=r["file"])
        for r in RECORDINGS
        if ("load_error" if "load_error" in expected(r) else expected(r)["final"]) in final.split()
    ]


class Run:
    """Ticks a tree; a Delay costs one tick, as time flies between ticks."""

    def __init__(self, file: str) -> None:
        self.fake = FakeWorld()
        self.tree: Tree = load(DATA / file, world=self.fake.world())
        self.goals: list[list[Any]] = []
        self.writes: list[list[Any]] = []
        self.statuses: list[Status] = []

    def go(self, ticks: int) -> Run:
        ids = {node.path: node.registration_name for node in self.tree.nodes}
        for k in range(1, ticks + 1):
            self.fake.clock.now += 1e6
            self.statuses.append(self.tree.tick())
            goals = self.fake.machines.sent[len(self.goals) :]
            self.goals += [[k, ids[g.node], g.machine, g.record, g.subtask] for g in goals]
            self.writes += [[k, *write] for write in self.fake.flags.writes[len(self.writes) :]]
            if self.statuses[-1].completed:
                break
        return self


@pytest.mark.parametrize(("file", "want"), by("SUCCESS FAILURE RUNNING"))
def test_same_goals_writes_and_statuses_as_the_library(file: str, want: dict[str, Any]) -> None:
    run = Run(file).go(200)
    assert len(run.tree.nodes) == want["nodes"]
    assert run.goals == want["goals"]
    assert run.writes == want["writes"]
    assert run.statuses[-1].name == want["final"]
    assert len(run.statuses) == want["ticks"]
    assert [status.name for status in run.statuses[9::10]] == want["status_every_10"]


@pytest.mark.parametrize(("file", "want"), by("load_error"))
def test_is_refused_as_by_the_library(file: str, want: dict[str, Any]) -> None:
    with pytest.raises(TreeError, match="main_tree_to_execute"):
        load(DATA / file)
    assert not check(DATA / file).ok


@pytest.mark.parametrize(("file", "want"), by("EXCEPTION DIVERGED"))
def test_defects_of_the_library_run_and_stop_at_once(file: str, want: dict[str, Any]) -> None:
    run = Run(file)
    assert run.tree.warnings, "the author must be told that the C++ system stops or hangs here"
    run.go(20)
    written, recorded = [w[1:] for w in run.writes], [w[1:] for w in want["writes"]]
    assert written[: len(recorded)] == recorded[: len(written)]
    assert len(written) >= min(len(recorded), 20)
    run.tree.halt()
    assert not run.tree.running()


def test_text_flag_ends_the_tree_as_its_author_meant() -> None:
    run = Run("task_with_navigation.xml").go(20)
    assert run.statuses == [SUCCESS]
    assert [write[1:] for write in run.writes] == [write[1:] for write in expected(RECORDINGS[-1])["writes"]]


def test_every_task_of_the_folder_has_a_recording() -> None:
    assert {path.name for path in DATA.glob("*.xml")} == {recording["file"] for recording in RECORDINGS}
    assert {expected(r).get("final", "load_error") for r in RECORDINGS} >= {*DEFECTS, "SUCCESS", "FAILURE"}
    assert issubclass(TickError, TreeError)
