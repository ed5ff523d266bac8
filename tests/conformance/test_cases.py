"""Every recorded case of the C++ library, at both levels; cases marked as a quirk with `load(quirks=True)`."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from conformance.case_file import Case, read_cases
from conformance.replay_cases import difference, replayed, scripted_registry

CASES = read_cases(Path(__file__).parent / "cases.jsonl")


@pytest.mark.parametrize("level", ["required", "strict"])
@pytest.mark.parametrize("case", CASES, ids=[case["id"] for case in CASES])
def test_case(case: Case, level: str) -> None:
    assert difference(case, scripted_registry(), level) == ""


def test_replay_notices_a_difference() -> None:
    case = next(case for case in CASES if case["id"] == "hand-repeat-async")
    changed = {**case, "xml": case["xml"].replace('num_cycles="', 'num_cycles="1')}
    assert difference(changed, scripted_registry(), "required")


def test_engine_is_saner_than_the_library_where_a_case_is_a_quirk() -> None:
    case = next(case for case in CASES if case["id"] == "hand-timed-quirk-timeout-halt")
    assert "SUCCESS" not in difference({**case, "quirk": False}, scripted_registry(), "required")
    assert "FAILURE instead of RUNNING" in difference({**case, "quirk": False}, scripted_registry(), "required")


def replay(*words: str | Path) -> subprocess.CompletedProcess[str]:
    script = Path(__file__).parent / "replay_cases.py"
    return subprocess.run([sys.executable, script, *words], capture_output=True, text=True, timeout=60, check=False)


def test_the_last_line_counts_and_failing_ids_come_before_it(tmp_path: Path) -> None:
    good = next(case for case in CASES if case["id"] == "hand-repeat-async")
    bad = {**good, "id": "bad", "xml": good["xml"].replace('num_cycles="', 'num_cycles="1')}
    short = {**good, "id": "short", "expected": {**good["expected"], "trace": good["expected"]["trace"][:-1]}}
    file = tmp_path / "cases.jsonl"
    file.write_text("\n".join(json.dumps(case) for case in (good, bad, short)) + "\n\n")
    end = replay(file, "--level", "strict")
    assert end.returncode == 1
    lines = end.stdout.splitlines()
    assert [line.split(":")[0] for line in lines] == ["bad", "short", "1 passed, 2 failed"]
    assert "tick" in lines[0]
    assert "more steps" in lines[1]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (None, "cannot be read"),
        ("", "no cases"),
        ('{"id": "a", "xml": "", "ticks": 1, "expected": {"load_error": {}}}\n{"id": ', ":2: this is not JSON"),
        ("[1]", ":1: a case is a JSON object"),
        ('{"id": "a", "xml": "", "expected": {}}', ":1: 'ticks' must be there"),
        ('{"id": "a", "xml": "", "ticks": 1, "expected": {"nodes": []}}', ":1: expected: 'bb_init' must be"),
        (
            '{"id": "a", "xml": "", "ticks": 2, "at_ms": [1], "expected": {"nodes": [], "bb_init": [], "trace": []}}',
            ":1: at_ms has 1 times for 2 ticks",
        ),
    ],
)
def test_cases_that_cannot_be_read_are_told_in_one_line(tmp_path: Path, text: str | None, says: str) -> None:
    file = tmp_path / "cases.jsonl"
    if text is not None:
        file.write_text(text)
    end = replay(file)
    assert (end.returncode, end.stdout) == (2, "")
    assert says in end.stderr
    assert end.stderr.count("\n") == 1


def test_an_unknown_level_is_told() -> None:
    end = replay("--level", "high")
    assert end.returncode == 2
    assert "required or strict" in end.stderr


def test_a_bug_of_the_engine_fails_its_case_only(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> str:
        raise KeyError("x")

    monkeypatch.setattr("conformance.replay_cases.difference", broken)
    assert replayed(CASES[0], scripted_registry(), "required") == "KeyError: 'x'"
