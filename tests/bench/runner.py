"""Runs the benchmark groups and compares their figures with limits and with a floor of the same run.

A group is a file in groups(): its `measure` yields figures. A limit is meant for a usual PC; where the floor shows that
this PC is slower (or busy), the limit grows by as much. A figure over a limit that its floor misses as well is neither
held nor short: it is shown as `floor`, since nothing of ours could reach it here.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from conftest import on_loopback
from tms_config.clock import utc_now
from tms_reason.errors import TmsError

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
HISTORY = PROJECT / ".state/bench/history.jsonl"
BROKEN = (AssertionError, OSError, subprocess.SubprocessError, TmsError)  # what a group breaks off with; others go on
TURNS = 10
COLUMNS = ("GROUP", "FIGURE", "VALUE", "FLOOR", "RATIO", "ALLOWED", "")


@dataclass(frozen=True)
class Figure:
    """Less is better."""

    name: str
    unit: str
    value: float
    limit: float
    floor: float | None = None  # the same work without what is measured; None: there is none, as of what is counted
    usual_floor: float | None = None  # on a usual PC; None: the floor says nothing about the speed of this PC
    note: str = ""  # which one, where the figure is the largest of many

    @property
    def ratio(self) -> float | None:
        return self.value / self.floor if self.floor else None

    @property
    def allowed(self) -> float:
        slower = self.floor / self.usual_floor if self.floor and self.usual_floor else 1.0
        return self.limit * max(1.0, slower)

    @property
    def verdict(self) -> str:
        if self.value <= self.allowed:
            return "held"
        bound = self.floor if self.usual_floor is None else None  # else it only tells the speed of this PC
        return "floor" if bound is not None and bound > self.allowed else "SHORT"

    def as_dict(self) -> dict[str, Any]:
        names = ("name", "unit", "value", "floor", "ratio", "limit", "allowed", "verdict", "note")
        found = {name: getattr(self, name) for name in names}
        return {key: float(f"{value:.4g}") if isinstance(value, float) else value for key, value in found.items()}


def milliseconds(*works: Callable[[], object], rounds: int) -> list[float]:
    """The median of several rounds of each; by turns, as a PC may become slower meanwhile."""
    times: list[list[float]] = [[] for _ in works]
    for _ in range(TURNS):
        for work, found in zip(works, times, strict=True):
            for _ in range(rounds // TURNS):
                start = time.perf_counter()
                work()
                found.append(time.perf_counter() - start)
    return [sorted(found)[len(found) // 2] * 1000 for found in times]


def groups() -> list[str]:
    """Files in this folder, but the runner and tests."""
    names = sorted(path.stem for path in HERE.glob("*.py"))
    return [name for name in names if name not in ("runner", "__main__") and not name.startswith("test_")]


def row(group: str, figure: Figure) -> tuple[str, ...]:
    value, floor, allowed = (_told(number, figure.unit) for number in (figure.value, figure.floor, figure.allowed))
    ratio = "" if figure.ratio is None else f"{figure.ratio:.2f}"
    return group, figure.name, value, floor, ratio, allowed, f"{figure.verdict}  {figure.note}"


def _told(number: float | None, unit: str) -> str:
    if number is None:
        return ""
    return f"{number:.3g} {unit}" if number < 1000 else f"{number:.0f} {unit}"


def show(cells: Iterable[str]) -> None:
    widths = (10, 34, 10, 10, 7, 10, 0)
    print("".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True)).rstrip(), flush=True)


def commit() -> str:
    found = subprocess.run(
        ["git", "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"],
        cwd=PROJECT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    return found.stdout.strip() or "unknown"


def remember(file: Path, figures: list[tuple[str, Figure]], seconds: dict[str, float]) -> None:
    """Append one line, so that commits can be compared."""
    file.parent.mkdir(parents=True, exist_ok=True)
    now = utc_now().isoformat(timespec="seconds")
    rows = [{"group": group, **figure.as_dict()} for group, figure in figures]
    line = {"commit": commit(), "at": now, "seconds": seconds, "figures": rows}
    with file.open("a", encoding="utf-8") as history:
        history.write(json.dumps(line) + "\n")


def main(words: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="bench", description="Benchmarks; exit code 1 if one is short or missing.")
    parser.add_argument("--only", metavar="GROUP", help=f"one of: {', '.join(groups())}")
    parser.add_argument("--json", type=Path, metavar="FILE", default=HISTORY, help="the history to append a line to")
    given = parser.parse_args(words)
    signal.signal(signal.SIGTERM, lambda _number, _frame: sys.exit(1))  # so that no mesh is left behind
    on_loopback()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # with it, every process that starts compiles its modules anew
    if given.only is not None and given.only not in groups():
        print(f"bench: there is no group {given.only!r}; there is: {', '.join(groups())}", file=sys.stderr)
        return 2
    show(COLUMNS)
    figures, seconds, broken = list[tuple[str, Figure]](), dict[str, float](), list[str]()
    for group in [given.only] if given.only else groups():
        begun = time.perf_counter()
        try:
            for figure in importlib.import_module(f"bench.{group}").measure():
                figures.append((group, figure))
                show(row(group, figure))
        except BROKEN:
            traceback.print_exc()
            broken.append(group)
        seconds[group] = round(time.perf_counter() - begun, 1)
    remember(given.json, figures, seconds)
    spent = ", ".join(f"{group} {passed:.0f} s" for group, passed in seconds.items())
    print(f"{sum(seconds.values()):.0f} s: {spent}")
    print(last_line([figure.verdict for _, figure in figures], broken))
    return 0 if not broken and all(figure.verdict != "SHORT" for _, figure in figures) else 1


def last_line(verdicts: list[str], broken: list[str]) -> str:
    floor = verdicts.count("floor")
    told = f"{verdicts.count('held')} held, {verdicts.count('SHORT')} short"
    return told + (f", {floor} at the floor" if floor else "") + (f"; broke off: {', '.join(broken)}" if broken else "")
