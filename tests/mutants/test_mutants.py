"""The catalogue of planted defects fits the code, and the runner tells what the simulation finds."""

import ast
import json
import re
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from mutants import hunt, run
from mutants.catalogue import SERVICES, DoesNotApply, Mutant, mutants
from mutants.ledger import Ledger
from mutants.plant import HuntFailed, Verdict, look_for, plant, read, simulate
from simulation.defences import WITHOUT

AT_LEAST = 60
LATCH = Mutant("a-defect", "tms_decision/latch.py", "self.closings += 1", "pass", "nobody counts")


def test_every_entry_applies_and_is_another_program() -> None:
    for one in mutants():
        before = ast.dump(ast.parse((SERVICES / one.file).read_text(encoding="utf-8")))
        assert ast.dump(ast.parse(one.source(), one.file)) != before, one.name
        compile(one.source(), one.file, "exec")


def test_there_are_enough_with_names_and_words() -> None:
    every = mutants()
    assert len(every) >= AT_LEAST
    assert [name for name, count in Counter(one.name for one in every).items() if count > 1] == []
    assert {name for one in every for name in one.without} == set(WITHOUT)
    assert [one.name for one in every if not re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)+", one.name) or not one.wrong] == []


def test_a_stale_entry_says_which_and_why() -> None:
    gone = Mutant("gone", "tms_decision/latch.py", "no such text", "", "nothing")
    twice = Mutant("twice", "tms_decision/latch.py", "self.held", "", "nothing")
    away = Mutant("away", "tms_decision/no_file.py", "", "", "nothing")
    for stale, says in ((gone, "0 times"), (twice, "times, not once"), (away, "no file tms_decision/no_file.py")):
        with pytest.raises(DoesNotApply, match=f"{stale.name}: .*{says}"):
            stale.source()


def test_a_defect_is_planted_in_a_copy(tmp_path: Path) -> None:
    before = (SERVICES / LATCH.file).read_text(encoding="utf-8")
    plant(LATCH, tmp_path)
    assert (tmp_path / LATCH.file).read_text(encoding="utf-8") == before.replace(LATCH.text, LATCH.becomes) != before
    assert (SERVICES / LATCH.file).read_text(encoding="utf-8") == before
    assert not list(tmp_path.rglob("latch.*.pyc"))


def test_a_planted_defect_is_found_in_a_fresh_interpreter() -> None:
    named = {one.name: one for one in mutants()}
    verdict = look_for(named["a-goal-does-not-wait-for-its-note"], 1, 50)
    assert not verdict.survived and verdict.seed == verdict.tried
    assert "the note does not say whose it is" in verdict.violation


def test_what_the_lack_of_other_defences_does_finds_no_mutant() -> None:
    """Seed 20280771 needs one of the two: without both, the code itself loses a press."""
    counts = Mutant(LATCH.name, LATCH.file, LATCH.text, "self.closings += 2", "nothing", tuple(WITHOUT))
    assert not simulate(counts, 20280771, 1).survived
    assert look_for(counts, 20280771, 1) == Verdict(counts.name, 1)


def done(code: int, *lines: object, stderr: str = "") -> "subprocess.CompletedProcess[str]":
    return subprocess.CompletedProcess(["hunt"], code, "".join(f"{json.dumps(line)}\n" for line in lines), stderr)


def test_the_output_of_a_hunt_is_read() -> None:
    seeds = {"seed": 7}, {"seed": 8}
    assert read("m", 7, done(0, *seeds)) == Verdict("m", 2)
    assert read("m", 7, done(0, *seeds, {"violation": "it moves"})) == Verdict("m", 2, 8, "it moves")
    assert read("m", 7, done(1, *seeds, stderr="Traceback\nKeyError: 3\n")).violation == "ends with KeyError: 3"
    assert read("m", 7, done(-signal.SIGXCPU, *seeds)) == Verdict("m", 2, 8, "does not end")
    with pytest.raises(HuntFailed, match="m: killed by signal 9 in seed 8"):
        read("m", 7, done(-signal.SIGKILL, *seeds))
    with pytest.raises(HuntFailed, match="m: no module"):
        read("m", 7, done(1, stderr="no module"))


def test_a_hunt_refuses_a_package_without_the_defect(tmp_path: Path) -> None:
    search = f"import sys; sys.path[:0] = {[str(SERVICES), str(SERVICES.parent / 'tests')]!r}; sys.argv[1:] = "
    code = search + "['tms_decision', '1', '1']; import runpy; runpy.run_module('mutants.hunt', run_name='__main__')"
    refused = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert refused.returncode == 1 and "tms_decision is not the planted one" in refused.stderr


# which of them


EVERY = [Mutant(f"m-{i}", LATCH.file, LATCH.text, LATCH.becomes, f"wrong {i}") for i in range(7)]


def test_a_slice_takes_all_of_them_by_turns() -> None:
    turns = [run.chosen(EVERY, (), 3, turn) for turn in range(100, 107)]
    assert all(len({one.name for one in turn}) == 3 for turn in turns)
    assert Counter(one.name for turn in turns for one in turn) == {one.name: 3 for one in EVERY}
    assert run.chosen(EVERY, (), 3, 100) == turns[0] and run.chosen(EVERY, (), 8, 5) == EVERY


def test_mutants_are_chosen_by_name() -> None:
    assert run.chosen(EVERY, ("m-4", "m-2"), None, 0) == [EVERY[2], EVERY[4]]
    with pytest.raises(click.UsageError, match="m-9"):
        run.chosen(EVERY, ("m-9",), None, 0)


# the runner


class Simulation:
    """Finds every mutant but one."""

    def __init__(self, survivor: str = "") -> None:
        self.survivor, self.asked = survivor, list[str]()

    def __call__(self, mutant: Mutant, seed: int, schedules: int) -> Verdict:
        self.asked.append(mutant.name)
        return (
            Verdict(mutant.name, schedules) if mutant.name == self.survivor else Verdict(mutant.name, 2, seed + 1, "!")
        )


@pytest.fixture
def simulation(monkeypatch: pytest.MonkeyPatch) -> Simulation:
    """Stands in for the processes of the mutants."""
    found = Simulation()
    monkeypatch.setattr(run, "mutants", lambda: EVERY)
    monkeypatch.setattr(run, "look_for", found)
    return found


def test_all_found_ends_well(simulation: Simulation) -> None:
    result = CliRunner().invoke(run.main, ["-n", "9", "--workers", "2"])
    assert result.exit_code == 0 and result.output.endswith("7 mutants, 0 survived\n")
    assert "m-3: found after 2 schedules (seed 2: !)" in result.output


def test_a_survivor_ends_with_exit_code_1(simulation: Simulation) -> None:
    simulation.survivor = "m-5"
    result = CliRunner().invoke(run.main, ["-n", "9", "--json"])
    assert result.exit_code == 1
    lines = [json.loads(line) for line in result.output.splitlines()]
    assert {"name": "m-5", "tried": 9, "seed": None, "violation": ""} in lines and lines[-1] == {
        "mutants": 7,
        "survived": 1,
    }


def test_a_series_is_continued(simulation: Simulation, tmp_path: Path) -> None:
    simulation.survivor = "m-5"
    for command in (["-n", "9", "--only", "m-1"], ["-n", "9"], ["-n", "10"]):
        result = CliRunner().invoke(run.main, [*command, "--ledger", str(tmp_path / "ledger")])
    assert Counter(simulation.asked) == {one.name: 1 for one in EVERY} | {"m-5": 2}
    assert "m-1: found" in result.output and result.output.endswith("7 mutants, 1 survived\n")


def test_an_entry_of_the_ledger_counts_for_the_same_mutant_only(tmp_path: Path) -> None:
    verdict = Verdict("m-1", 2, 2, "!")
    Ledger(tmp_path / "ledger", 1, 9).keep(EVERY[1], verdict)
    assert Ledger(tmp_path / "ledger", 1, 9).known(EVERY[1]) == verdict
    assert Ledger(tmp_path / "ledger", 1, 1).known(EVERY[1]) is None
    assert Ledger(tmp_path / "ledger", 2, 9).known(EVERY[1]) is None
    assert Ledger(tmp_path / "ledger", 1, 9).known(EVERY[2]) is None


def test_a_seed_that_violates_without_a_defect_finds_no_mutant(
    simulation: Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Violates:
        violation = "it moves anyway"

        def __init__(self, seed: int) -> None: ...

        def run(self) -> "Violates":
            return self

    monkeypatch.setattr(hunt, "Schedule", Violates)
    result = CliRunner().invoke(run.main, ["-n", "9"])
    assert result.exit_code == 1 and "without any defect, seed 2 violates: it moves anyway" in result.output


def test_the_help_has_examples() -> None:
    assert "make mutants SLICE=20" in CliRunner().invoke(run.main, ["--help"]).output
