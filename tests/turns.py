"""Long tests come by turns: `make test` takes those of its weekday, `make test TURN=all` all of them.

Where a module has the mark `turns`, it comes as a whole: most of what it costs is its mesh. Where a test has it, its
cases are shared out.
"""

from collections.abc import Sequence
from datetime import date
from pathlib import Path

import pytest

import sharing

TURNS = 7  # days of a week, from Monday on
TODAY, ALL = "today", "all"


def add_option(parser: pytest.Parser) -> None:
    """`--turn`, of pytest."""
    parser.addoption("--turn", default=ALL, help=f"long tests of this turn only: 1 to {TURNS}, or `{TODAY}`")


def settle(config: pytest.Config) -> None:
    """Say which turn is meant, before the workers start: midnight may come. pytest.UsageError if there is none such."""
    word = config.option.turn
    if word == TODAY:
        config.option.turn = str(date.today().isoweekday())
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
    late = [path for path, own in _spread({item.path for item in whole}).items() if own != turn]
    cases = sorted(shared, key=lambda one: one.nodeid)
    return {item for item in whole if item.path in late} | {
        item for place, item in enumerate(cases) if place % TURNS != turn - 1
    }


def _spread(files: set[Path]) -> dict[Path, int]:
    """A turn for each file, so that all turns cost about the same: the most costly first, to the cheapest turn."""
    found, costs = dict[Path, int](), dict.fromkeys(range(1, TURNS + 1), 0)
    for path in sorted(files, key=lambda path: (-sharing.cost(path), path)):
        found[path] = min(costs, key=lambda turn: costs[turn])
        costs[found[path]] += max(1, sharing.cost(path))
    return found


def _of_module(item: pytest.Item) -> bool:
    module = item.getparent(pytest.Module)
    return module is not None and any(mark.name == "turns" for mark in module.own_markers)
