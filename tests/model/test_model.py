"""The driver of `make model`: what it reads of SPIN, and that every defect is a name of the model."""

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from model import run
from model.checks import CHECKS, DEFECTS, SMALL
from model.spin import SITE, SIZES, Check, Found, ModelError, read

WHOLE = """
State-vector 124 byte, depth reached 264, errors: 0
  1428774 states, stored
"""
FOUND = """
pan:1: assertion violated !(stopped[g]) (at depth 68)
Warning: Search not completed
State-vector 124 byte, depth reached 68, errors: 1
 1.5e+06 states, stored
"""


def test_the_states_of_a_whole_search_are_read() -> None:
    assert read(WHOLE) == Found(1428774)


def test_a_violation_is_read() -> None:
    assert read(FOUND) == Found(1_500_000, "assertion violated !(stopped[g]) (at depth 68)")


@pytest.mark.parametrize("words", ["error: max search depth too small", "pan: out of memory", "Search not completed"])
def test_a_search_that_is_not_exhaustive_is_an_error(words: str) -> None:
    with pytest.raises(ModelError):
        read(f"{words}\n{WHOLE}")


def test_other_words_are_an_error() -> None:
    with pytest.raises(ModelError):
        read("Segmentation fault")


def test_every_size_is_given_to_the_model() -> None:
    assert SMALL.definitions("LOSS_NOT_SEEN")[0] == "-DMACHINES=1"
    assert SMALL.definitions("LOSS_NOT_SEEN")[-1] == "-DLOSS_NOT_SEEN"
    assert all(len(check.sizes) == len(SIZES) for check in CHECKS)


def test_at_least_twelve_defects_are_planted_where_the_model_looks_at_them() -> None:
    text = "".join(path.read_text(encoding="utf-8") for path in SITE.parent.glob("*.pml"))
    planted = set(re.findall(r"#ifn?def ([A-Z_]+)", text)) - {"HISTORY"}
    assert planted == set(DEFECTS) and len(planted) >= 12


def search(violation: str) -> object:
    def explore(check: Check, folder: Path, seconds: float, *defects: str) -> Found:
        return Found(1000, violation, ("the scheduler is killed",) if violation else ())

    return explore


def test_the_last_line_counts_states_and_violations(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "explore", search(""))
    done = CliRunner().invoke(run.main, [])
    assert done.exit_code == 0
    assert done.output.splitlines()[-1] == f"{1000 * len(CHECKS)} states, 0 violations"


def test_a_violation_is_told_in_words_and_ends_with_code_1(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "explore", search("it moves"))
    done = CliRunner().invoke(run.main, ["--only", CHECKS[0].name])
    assert done.exit_code == 1
    assert "the scheduler is killed" in done.output and "VIOLATION: it moves" in done.output


def test_a_defect_that_is_not_found_ends_with_code_1(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "explore", search(""))
    done = CliRunner().invoke(run.main, ["--defects", "--only", "LOSS_NOT_SEEN"])
    assert done.exit_code == 1
    assert done.output.splitlines()[-1] == "1 defects, 1 survived"


def test_an_unknown_name_is_refused() -> None:
    assert CliRunner().invoke(run.main, ["--only", "nothing"]).exit_code == 2
