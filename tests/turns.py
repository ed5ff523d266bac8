"""Long tests come by turns: `make test` takes some of them, each day others, and `make test TURN=all` all of them.

Where a module has the mark `turns`, it comes as a whole: most of what it costs is its mesh. Where a test has it, its
cases are shared out.
"""

from collections.abc import Iterable, Sequence
from datetime import date
from pathlib import Path
from typing import TypeVar

import pytest

import sharing

TURNS = 4
TODAY, ALL = "today", "all"
T = TypeVar("T")


def add_option(parser: pytest.Parser) -> None:
    """`--turn`, of pytest."""
    parser.addoption("--turn", default=ALL, help=f"long tests of this turn only: 1 to {TURNS}, or `{TODAY}`")


def settle(config: pytest.Config) -> None:
    """Say which turn is meant, before the workers start: midnight may come. pytest.UsageError if there is none such."""
    word = config.option.turn
    if word == TODAY:
        config.option.turn = str(date.today().toordinal() % TURNS + 1)
    elif word != ALL and word not in map(str, range(1, TURNS + 1)):
        raise pytest.UsageError(f"--turn={word}: {TODAY}, {ALL}, or a number from 1 to {TURNS}")


def waiting(items: Sequence[pytest.Item], word: str) -> set[pytest.Item]:
    """Those that do not come in the turn that `--turn` names."""
    if word == ALL:
        return set()
    turn, whole, shared = int(word), list[pytest.Item](), list[pytest.Item]()
    for item in items:
        if item.get_closest_marker("turns") is not None:
            (whole if _of_module(item) else shared).append(item)
    late = set(_others(sorted({item.path for item in whole}, key=_longest_first), turn))
    cases = _others(sorted(shared, key=lambda one: one.nodeid), turn)
    return {item for item in whole if item.path in late} | set(cases)


def _of_module(item: pytest.Item) -> bool:
    module = item.getparent(pytest.Module)
    return module is not None and any(mark.name == "turns" for mark in module.own_markers)


def _longest_first(path: Path) -> tuple[int, str]:
    known = path.stem in sharing.LONGEST
    return sharing.LONGEST.index(path.stem) if known else len(sharing.LONGEST), str(path)


def _others(all_of_them: Iterable[T], turn: int) -> list[T]:
    return [one for place, one in enumerate(all_of_them) if _turn(place) != turn]


def _turn(place: int) -> int:
    """To and fro, so that the longest of each round do not all come in the same turn."""
    step = place % (2 * TURNS)
    return 1 + min(step, 2 * TURNS - 1 - step)
