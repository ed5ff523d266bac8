"""Plants one defect in a copy of its package, and lets a fresh interpreter look for it."""

import json
import os
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from mutants.catalogue import SERVICES, Mutant

TESTS = Path(__file__).resolve().parents[1]


class HuntFailed(Exception):
    """The mutant's process has ended before its first schedule, or by a signal."""


@dataclass(frozen=True)
class Verdict:
    """What the simulation says of one mutant."""

    name: str
    tried: int  # schedules
    seed: int | None = None  # that finds it
    violation: str = ""  # of an invariant; or how the process has ended

    @property
    def survived(self) -> bool:
        return self.seed is None


def plant(mutant: Mutant, folder: Path, services: Path = SERVICES) -> None:
    """A copy of the package with the defect."""
    stale = shutil.ignore_patterns(f"{Path(mutant.file).stem}.*.pyc")
    shutil.copytree(services / mutant.package, folder / mutant.package, ignore=stale)
    (folder / mutant.file).write_text(mutant.source(services), encoding="utf-8")


def look_for(mutant: Mutant, seed: int, schedules: int) -> Verdict:
    """Simulate until an invariant is violated by the defect, not by the lack of the defences that are put out."""
    verdict, tried = simulate(mutant, seed, schedules), 0
    while mutant.without and verdict.seed is not None and not simulate(mutant.sound, verdict.seed, 1).survived:
        tried += verdict.tried
        if tried == schedules:
            return Verdict(mutant.name, tried)
        verdict = simulate(mutant, seed + tried, schedules - tried)
    return replace(verdict, tried=tried + verdict.tried)


def simulate(mutant: Mutant, seed: int, schedules: int) -> Verdict:
    """Schedules in an interpreter of their own, until one violates an invariant."""
    with TemporaryDirectory(prefix="mutant-") as name:
        folder = Path(name).resolve()
        plant(mutant, folder)
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, (folder, TESTS, SERVICES))),
            "PYTHONHASHSEED": "0",
        }
        command = [sys.executable, "-m", "mutants.hunt", mutant.package, str(seed), str(schedules), *mutant.without]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    return read(mutant.name, seed, done)


def read(name: str, seed: int, done: "subprocess.CompletedProcess[str]") -> Verdict:
    """The verdict in the output of a hunt; a defect may also end the process by an exception, or loop for ever."""
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    seeds = [line["seed"] for line in lines if "seed" in line]
    if not seeds:
        raise HuntFailed(f"{name}: {done.stderr.strip()}")
    tried = seeds[-1] - seed + 1
    if done.returncode == -signal.SIGXCPU:
        return Verdict(name, tried, seeds[-1], "does not end")
    if done.returncode < 0:
        raise HuntFailed(f"{name}: killed by signal {-done.returncode} in seed {seeds[-1]}")
    if done.returncode:
        return Verdict(name, tried, seeds[-1], f"ends with {done.stderr.strip().splitlines()[-1]}")
    if "violation" in lines[-1]:
        return Verdict(name, tried, seeds[-1], lines[-1]["violation"])
    return Verdict(name, tried)
