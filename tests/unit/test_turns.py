"""Long tests come by turns: each in one of them, and those without the mark in all."""

import pytest

import turns

pytest_plugins = ["pytester"]
CONFTEST = """
import turns

def pytest_addoption(parser):
    turns.add_option(parser)

def pytest_configure(config):
    turns.settle(config)

def pytest_collection_modifyitems(config, items):
    late = turns.waiting(items, config.option.turn)
    items[:] = [item for item in items if item not in late]
"""
LONG = "import pytest\npytestmark = [pytest.mark.turns]\ndef test_one(): pass\ndef test_two(): pass"
CASES = """
import pytest

@pytest.mark.turns
@pytest.mark.parametrize("case", range(9))
def test_case(case): pass

def test_short(): pass
"""


@pytest.fixture
def project(pytester: pytest.Pytester) -> pytest.Pytester:
    """Eight long modules, and one with nine long cases and a short test."""
    pytester.makeini("[pytest]\nmarkers = turns: long")
    pytester.makeconftest(CONFTEST)
    pytester.makepyfile(test_cases=CASES, **{f"test_{letter}": LONG for letter in "abcdefgh"})
    return pytester


def collected(project: pytest.Pytester, *words: str) -> list[str]:
    _, record = project.inline_genitems(*words)
    ends = [call.session.items for call in record.getcalls("pytest_collection_finish")]
    return sorted(item.nodeid for item in ends[-1])


def test_each_comes_in_one_turn(project: pytest.Pytester) -> None:
    every = collected(project)
    assert every == collected(project, "--turn=all")
    assert len(every) == 26
    taken = [collected(project, f"--turn={number}") for number in range(1, turns.TURNS + 1)]
    short = "test_cases.py::test_short"
    assert all(short in turn for turn in taken)
    assert sorted(one for turn in taken for one in turn if one != short) == sorted(set(every) - {short})
    cases = [sum("test_case[" in one for one in turn) for turn in taken]
    modules = [{one.partition("::")[0] for one in turn if "test_cases" not in one} for turn in taken]
    assert sorted(cases) == [1, 1, 1, 1, 1, 2, 2] and sorted(map(len, modules)) == [1, 1, 1, 1, 1, 1, 2]
    assert all(f"{name}::{test}" in turn for turn, names in zip(taken, modules, strict=True)
               for name in names for test in ("test_one", "test_two"))  # fmt: skip


def test_today_is_one_of_them(project: pytest.Pytester) -> None:
    today = collected(project, "--turn=today")
    assert today in [collected(project, f"--turn={number}") for number in range(1, turns.TURNS + 1)]


@pytest.mark.parametrize("word", ["0", str(turns.TURNS + 1), "monday"])
def test_a_turn_that_is_none_is_refused(project: pytest.Pytester, word: str) -> None:
    told = project.runpytest_inprocess(f"--turn={word}")
    assert told.ret == pytest.ExitCode.USAGE_ERROR
    told.stderr.fnmatch_lines([f"*--turn={word}: today, all, or a number from 1 to {turns.TURNS}*"])
