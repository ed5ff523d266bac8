"""What the drill tries and how it counts."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tms_cli.commands import drill
from tms_cli.drill.patrol import Patrol
from tms_cli.drill.report import markdown
from tms_cli.drill.rows import KILL, LEFT_OUT, RESTART, Case, Row, cases, choose, percentile, summary
from tms_core.errors import TmsError

MOVERS, OTHERS = ["tms:ts", "zx200:rc", "zx200:rp"], ["tms:db", "tms:host", "tms:store"]
SUBTASKS = ["zx200:dig", "zx200:turn", "zx200:dig", "zx200:drop"]


def test_quick_has_twenty_kills_and_full_has_every_pair() -> None:
    quick = cases(MOVERS, SUBTASKS, OTHERS, quick=True)
    assert sum(case.how == KILL for case in quick) >= 20
    full = {(case.process, case.leaf) for case in cases(MOVERS, SUBTASKS, OTHERS, quick=False) if case.how == KILL}
    assert len(full) == 7 * 4


def test_percentiles() -> None:
    assert percentile([], 0.99) is None
    assert percentile([3.0, 1.0, 2.0], 0.5) == 2.0
    assert percentile([float(n) for n in range(1, 101)], 0.99) == 99.0


def test_the_summary_counts_what_matters() -> None:
    good = Row("zx200:rc", "0.0", KILL, "zx200", True, 0.5, 1.2, 0.1, True, 2.0, "goes on")
    slow = Row("zx200:rp", "0.0", RESTART, "zx200", True, 0.9, 1.0, 0.1, True, 2.0, "goes on")
    bad = Row("tms:db", "0.1", KILL, "zx200", False)
    late = Row("tms:db", "0.2", KILL, "zx200", False, outcome=LEFT_OUT)
    found = summary([good, slow, bad, late])
    assert (found["kills"], found["unconfirmed"], found["hung"]) == (2, 1, 1)
    assert found["kill_to_stop_max_s"] == 0.5  # an orderly restart is no kill
    assert found["left_out"] == 1
    assert [row["ok"] for row in found["rows"]] == [True, True, False, False]
    page = markdown([good, bad], found, "demo")
    assert "停止" in page and "| zx200:rc | 0.0 | SIGKILL | 0.500 |" in page


def test_a_case_is_chosen_for_the_leaf_that_runs_and_movers_only_when_the_motion_is_fresh() -> None:
    mover, other = Case("zx200:rc", 1, KILL, True), Case("tms:db", 1, KILL, False)
    todo = [other, mover, Case("zx200:rp", 2, KILL, True)]
    assert choose(todo, 1, fresh=True) == mover
    assert choose(todo, 1, fresh=False) == other
    assert choose(todo, 2, fresh=False) is None
    assert choose(todo, -1, fresh=True) is None


def test_a_process_that_never_came_back_counts() -> None:
    lost = Row("tms:db", "0.1", KILL, "zx200", False, confirmed=True, outcome="goes on")
    found = summary([lost])
    assert (found["unconfirmed"], found["hung"], found["not_back"]) == (0, 0, 1)
    assert "復帰しなかったプロセス | 1 |" in markdown([lost], found, "demo")


@pytest.mark.parametrize(("back", "code"), [(2.0, 0), (None, 1)])
def test_the_exit_code_tells_of_it(
    mesh: Any, tms: Any, monkeypatch: pytest.MonkeyPatch, back: float | None, code: int
) -> None:
    row = Row("tms:db", "0.1", KILL, "zx200", False, None, None, 0.0, True, back, "goes on")
    monkeypatch.setattr(drill.mesh, "up", lambda _: False)
    monkeypatch.setattr(drill.mesh, "wait_ready", lambda *_: None)
    monkeypatch.setattr(drill, "drill", lambda *_: [row])
    end = tms(drill.command)
    assert end.exit_code == code
    assert f"{code} processes not back" in end.stdout


def test_a_report_that_cannot_be_written_is_told_before_anything_is_killed(
    tmp_path: Path, tms: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drill.mesh, "up", lambda _: pytest.fail("it began"))
    end = tms(drill.command, "--report", tmp_path / "out" / "drill.md")
    assert "its folder is not there" in str(end.exception)


class Broken:
    """A run that begins once, and a mesh that does not get ready again."""

    leaf, losses, lost = 0, 0, False

    def __init__(self) -> None:
        self.begun = 0

    def idle(self) -> bool:
        return True

    def begin(self, resume: bool = False) -> None:
        self.begun += 1
        if self.begun > 1:
            raise TmsError("tms:db is not ready after 60 s")

    def end(self) -> None:
        raise TmsError("nobody answers", "NO_ANSWER")


def test_what_was_seen_outlives_a_mesh_that_does_not_get_ready_again(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = Case("zx200:rc", 0, KILL, True), Case("zx200:rp", 0, KILL, True)
    eyes = SimpleNamespace(moving=lambda: True, fresh=lambda: True)
    seen = Row("zx200:rc", "0.0", KILL, "zx200", True, 0.5, 1.2, 0.1, True, 2.0, "goes on")
    patrol = Patrol("zx200", ["0.0"], 2, eyes, Broken(), SimpleNamespace(run=lambda *_: seen))  # type: ignore[arg-type]
    rows = patrol.walk([first, second], 60.0)
    assert [(row.process, row.outcome) for row in rows] == [("zx200:rc", "goes on"), ("zx200:rp", LEFT_OUT)]
    told = capsys.readouterr().err
    assert "tms:db is not ready after 60 s" in told and "nobody answers" in told


def test_a_process_that_is_gone_before_it_is_hit_is_no_end_of_the_drill() -> None:
    def gone(*_: Any) -> Row:
        raise ProcessLookupError(3, "No such process")

    eyes, work = (
        SimpleNamespace(moving=lambda: True, fresh=lambda: True),
        SimpleNamespace(leaf=0, losses=0, lost=False, idle=lambda: False, end=lambda: None),
    )
    patrol = Patrol("zx200", ["0.0"], 2, eyes, work, SimpleNamespace(run=gone))  # type: ignore[arg-type]
    (row,) = patrol.walk([Case("zx200:rc", 0, KILL, True)], 60.0)
    assert not row.ok
