"""What mutmut tells is counted by function, and what survives beyond the judged list is named."""

from collections import Counter
from pathlib import Path

import pytest
from click.testing import CliRunner

from mutants import mutmut_run
from mutants.mutmut_run import CHANGED, LEAST, Judged, judged, lay_out, read, unjudged

TOLD = """    tms_proof.channel.xǁChannelǁ_leaps__mutmut_1: killed
    tms_proof.channel.xǁChannelǁ_leaps__mutmut_2: survived
    tms_proof.channel.xǁChannelǁ_leaps__mutmut_13: no tests
    tms_proof.channel.x_distance__mutmut_1: timeout
    tms_proof.standstill.x__channels__mutmut_6: survived
something else
"""


def test_survivors_are_counted_by_function() -> None:
    left = Counter({"tms_proof.channel.Channel._leaps": 2, "tms_proof.standstill._channels": 1})
    assert read(TOLD.splitlines()) == (5, left)


def test_only_as_many_as_were_judged_may_survive() -> None:
    known = {"a.one": Judged(2, "equal"), "a.two": Judged(1, "equal")}
    assert unjudged({"a.one": 2}, known) == []
    assert unjudged({"a.one": 3, "a.two": 1, "a.three": 1}, known) == [
        "a.one: 3 survived, 2 are judged",
        "a.three: 1 survived, 0 are judged",
    ]


def test_the_judged_ones_have_a_reason_and_are_few() -> None:
    every = judged()
    assert all(one.count > 0 and one.why for one in every.values())
    assert sum(one.count for one in every.values()) < 1000 * (1 - LEAST)


def test_code_and_tests_are_laid_out_afresh(tmp_path: Path) -> None:
    folder = tmp_path / "mutmut"
    folder.mkdir()
    (folder / "of-yesterday").touch()
    lay_out(folder)
    assert not (folder / "of-yesterday").exists()
    assert all((folder / one).exists() for one in (*CHANGED, "configs", "tests/conftest.py", "tests/unit/tms_proof"))


@pytest.mark.parametrize(("killed", "survived", "code"), [(99, 1, 0), (98, 2, 1), (5, 1, 1), (0, 0, 1)])
def test_its_exit_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, killed: int, survived: int, code: int) -> None:
    """One survivor was judged, and 9 of 10 must be killed."""
    statuses = ["killed"] * killed + ["survived"] * survived
    lines = [f"    tms_proof.channel.x_distance__mutmut_{i}: {status}" for i, status in enumerate(statuses)]
    monkeypatch.setattr(mutmut_run, "lay_out", lambda folder: None)
    monkeypatch.setattr(mutmut_run, "judged", lambda: {"tms_proof.channel.distance": Judged(1, "equal")})
    monkeypatch.setattr(mutmut_run, "tested", lambda folder, workers: lines)
    result = CliRunner().invoke(mutmut_run.main, [str(tmp_path)])
    assert result.exit_code == code and f"{killed} killed" in result.output
