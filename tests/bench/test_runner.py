"""The runner of benchmarks: verdicts, groups, history. Nothing is timed here."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from bench import runner
from bench.runner import Figure


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    module = ModuleType("bench.made_up")
    module.measure = lambda: [
        Figure("fast", "ms", 1.0, 2.0, 0.5),
        Figure("slow", "ms", 1234.0, 2.0, 0.5, note="the third"),
    ]
    monkeypatch.setitem(sys.modules, "bench.made_up", module)
    monkeypatch.setattr(runner, "groups", lambda: ["made_up"])


@pytest.mark.parametrize(
    ("figure", "verdict"),
    [
        (Figure("as slow as the PC", "ms", 1.9, 1.0, floor=2.0, usual_floor=1.0), "held"),
        (Figure("slower than the PC", "ms", 2.1, 1.0, floor=2.0, usual_floor=1.0), "SHORT"),
        (Figure("a faster PC", "ms", 1.0, 1.0, floor=0.1, usual_floor=1.0), "held"),
        (Figure("over it", "B", 1.1, 1.0, floor=0.5), "SHORT"),
        (Figure("the floor misses it as well", "B", 2.1, 1.0, floor=2.0), "floor"),
        (Figure("a floor that tells the speed", "ms", 0.2, 0.1, floor=0.23, usual_floor=0.69), "SHORT"),
        (Figure("below its floor", "B", 0.9, 1.0, floor=2.0), "held"),
        (Figure("counted", "", 1.0, 0.5), "SHORT"),
    ],
)
def test_verdicts(figure: Figure, verdict: str) -> None:
    assert figure.verdict == verdict


def test_ratios() -> None:
    assert Figure("f", "B", 3.0, 1.0, floor=2.0).ratio == 1.5
    assert Figure("counted", "", 1.0, 0.5).ratio is None


def test_figures_at_the_floor_are_counted_apart() -> None:
    assert runner.last_line(["held", "floor", "held"], []) == "2 held, 0 short, 1 at the floor"
    assert runner.last_line(["held", "SHORT"], ["db"]) == "1 held, 1 short; broke off: db"


def test_a_group_is_a_file() -> None:
    assert "tree" in runner.groups()
    for path in Path(runner.__file__).parent.glob("*.py"):
        assert path.stem in runner.groups() or path.name.startswith(("test_", "__")) or path.stem == "runner"


def test_table_last_line_and_history(made_up: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "new/history.jsonl"
    assert runner.main(["--json", str(file)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].split() == ["made_up", "fast", "1", "ms", "0.5", "ms", "2.00", "2", "ms", "held"]
    assert lines[2].split()[-3:] == ["SHORT", "the", "third"]
    assert lines[3:] == ["0 s: made_up 0 s", "1 held, 1 short"]
    runner.main(["--json", str(file), "--only", "made_up"])
    first, _ = map(json.loads, file.read_text().splitlines())
    assert first["commit"]
    assert first["seconds"] == {"made_up": 0.0}
    assert first["figures"][1] == {
        "group": "made_up", "name": "slow", "unit": "ms", "value": 1234.0, "floor": 0.5, "ratio": 2468.0, "limit": 2.0,
        "allowed": 2.0, "verdict": "SHORT", "note": "the third",
    }  # fmt: skip


def test_a_group_that_breaks_off_is_told_and_the_others_go_on(
    made_up: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def measure() -> Iterator[Figure]:
        yield Figure("before", "ms", 1.0, 2.0, 0.5)
        raise TimeoutError("not within 60 s: a gateway")

    module = ModuleType("bench.away")
    module.measure = measure
    monkeypatch.setitem(sys.modules, "bench.away", module)
    monkeypatch.setattr(runner, "groups", lambda: ["away", "made_up"])
    sys.modules["bench.made_up"].measure = lambda: [Figure("fast", "ms", 1.0, 2.0, 0.5)]
    assert runner.main(["--json", str(tmp_path / "history.jsonl")]) == 1
    said = capsys.readouterr()
    assert [line.split()[1] for line in said.out.splitlines()[1:3]] == ["before", "fast"]
    assert said.out.splitlines()[-1] == "2 held, 0 short; broke off: away"
    assert "TimeoutError: not within 60 s: a gateway" in said.err


def test_an_unknown_group_is_told_with_the_groups_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert runner.main(["--only", "tre"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == f"bench: there is no group 'tre'; there is: {', '.join(runner.groups())}\n"
