"""The table of requirements: what was measured, whether it holds, and the files that keep it."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

REQUIREMENTS = {
    1: "Task and parameter data are in MongoDB (Tables 1 and 2)",
    2: "A node registers a task by its file name and adds the metadata (Table 3)",
    3: "Groot as editor: XML in, palette of leaf nodes out",
    4: "Groot as monitor: grey, orange, green while it runs",
    5: "A task is chosen by its id; the subtasks of its leaves are started beforehand",
    6: "One button starts the task, another stops it in an emergency",
    7: "Leaf nodes: model_name, record_name, subtask_name; the user writes names only",
    8: "Subtask nodes: accept or reject, feedback, result, cancel, parameters at any time",
    9: "Running, failed and done goals are RUNNING, FAILURE and SUCCESS of their leaves",
    10: "Cancel from the root down; the scheduler knows that the machine has stopped",
    11: "Sensing renews dynamic parameters, nearly in real time; a run changes no static one",
    12: "Outputs: OPERA machines and OperaSim-PhysX",
    13: "The verification run: zx200 in the simulator, watched in Groot",
}
NOT_REACHED = "not reached"
WIDTH = 100  # columns of the figures on a terminal


@dataclass(frozen=True)
class Row:
    """One requirement. It holds if something was measured and nothing was wrong with it."""

    number: int
    measured: tuple[str, ...]
    problems: tuple[str, ...] = ()

    @property
    def held(self) -> bool:
        return bool(self.measured) and not self.problems

    def as_dict(self) -> dict[str, Any]:
        return {
            "number": self.number, "requirement": REQUIREMENTS[self.number], "held": self.held,
            "measured": list(self.measured), "problems": list(self.problems),
        }  # fmt: skip


class Book:
    """What is measured, requirement by requirement, in any order."""

    def __init__(self) -> None:
        self._measured: dict[int, list[str]] = {number: [] for number in REQUIREMENTS}
        self._problems: dict[int, list[str]] = {number: [] for number in REQUIREMENTS}

    def note(self, number: int, measured: str, problems: Iterable[str] = ()) -> None:
        """Add a figure to a requirement, and what is wrong with it."""
        self._measured[number].append(measured)
        self._problems[number] += problems

    def check(self, number: int, measured: str, holds: bool) -> None:
        """Add a figure that is wrong as a whole, or right."""
        self.note(number, measured, () if holds else (measured,))

    def rows(self, unfinished: bool) -> list[Row]:
        """All requirements. `unfinished`: the scenario broke off, so that what comes last was not seen."""
        found = []
        for number, measured in self._measured.items():
            missing = [NOT_REACHED] if not measured or (unfinished and number == max(REQUIREMENTS)) else []
            found.append(Row(number, tuple(measured), (*self._problems[number], *missing)))
        return found


def exit_code(rows: Sequence[Row]) -> int:
    """0 if every row holds."""
    return 0 if all(row.held for row in rows) else 1


def terminal(rows: Sequence[Row]) -> str:
    """The table for a terminal."""
    lines = []
    for row in rows:
        lines.append(f"{row.number:>2}  {'held' if row.held else 'FAILS'}  {REQUIREMENTS[row.number]}")
        for text in (*row.measured, *(f"WRONG: {problem}" for problem in row.problems)):
            lines += textwrap.wrap(text, WIDTH, initial_indent=" " * 10, subsequent_indent=" " * 12)
    return "\n".join(lines)


def markdown(rows: Sequence[Row], commit: str, at: str, seconds: float) -> str:
    """The table as a document."""
    lines = [
        "# Verification", "", f"Commit `{commit}`, {at}, {seconds:.0f} s.", "",
        "| # | requirement | measured | |", "| --- | --- | --- | --- |",
    ]  # fmt: skip
    for row in rows:
        texts = (*row.measured, *(f"**wrong: {problem}**" for problem in row.problems))
        cell = "<br>".join(text.replace("|", "\\|") for text in texts)
        lines.append(f"| {row.number} | {REQUIREMENTS[row.number]} | {cell} | {'held' if row.held else '**FAILS**'} |")
    return "\n".join(lines) + "\n"


def write(folder: Path, rows: Sequence[Row], commit: str, at: str, seconds: float) -> None:
    """Keep the table as `verification.json` and `verification.md`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "verification.md").write_text(markdown(rows, commit, at, seconds), encoding="utf-8")
    whole = {"commit": commit, "at": at, "seconds": round(seconds, 1), "rows": [row.as_dict() for row in rows]}
    (folder / "verification.json").write_text(json.dumps(whole, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
