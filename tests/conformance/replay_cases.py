"""Replay recorded cases and compare: `replay_cases.py CASES [--level required|strict]`.

Prints failing ids with their first difference, and `N passed, M failed` last. Exit code: 0 all passed, 1 some failed,
2 the cases cannot be read.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
for folder in (HERE, HERE.parents[1] / "services"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

from case_file import BadCases, Case, read_cases  # noqa: E402
from scripted import events, scripted_registry  # noqa: E402

from tms_ts.bt import Registry, Status, Tree, TreeError, load  # noqa: E402

LEVELS = ("required", "strict")
BUGS = (ArithmeticError, AttributeError, LookupError, RuntimeError, TypeError, ValueError)
TYPES = {bool: "bool", int: "int", float: "double", str: "string"}


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class Player:
    """Runs one case and notes what a recording notes."""

    def __init__(self, case: Case, registry: Registry) -> None:
        self.case = case
        self.clock = Clock()
        self.tree: Tree = load(
            case["xml"],
            registry=registry,
            blackboard=case.get("bb0"),
            clock=self.clock,
            quirks=bool(case.get("quirk")),  # those cases record a defect of the library
        )
        self.index = {node: i for i, node in enumerate(self.tree.nodes)}
        self.transitions: list[str] = []
        self.tree.observers.append(self.observe)
        self.boards = self.blackboards()

    def observe(self, node: Any, old: Status, new: Status) -> None:
        self.transitions.append(f"{self.index[node]}{old.name[0]}{new.name[0]}")

    def blackboards(self) -> list[dict[str, list[Any]]]:
        return [
            {key: [TYPES[type(value)], value] for key, value in board.items() if type(value) in TYPES}
            for board in self.tree.blackboards
        ]

    def nodes(self) -> list[list[str]]:
        return [[node.path, node.registration_name, node.name] for node in self.tree.nodes]

    def trace(self) -> Iterator[dict[str, Any]]:
        case = self.case
        halts = case.get("halt_at") or []
        for k in range(1, case["ticks"] + 1):
            if case.get("at_ms"):
                self.clock.now = case["at_ms"][k - 1] / 1000
            step: dict[str, Any] = {"k": k}
            try:
                step["root"] = self.tree.tick().name
            except TreeError as error:
                step["exc"] = str(error)
            yield self.completed(step)
            if "exc" in step:
                return
            if k in (halts if isinstance(halts, list) else [halts]):
                mode = case.get("halt_mode", "tree")
                self.tree.halt_root() if mode == "root" else self.tree.halt()
                yield self.completed({"halt": mode})

    def completed(self, step: dict[str, Any]) -> dict[str, Any]:
        step["st"] = "".join(node.state.name[0] for node in self.tree.nodes)
        step["ev"] = [[self.index[event[0]], *event[1:]] for event in events]
        step["tr"] = " ".join(self.transitions)
        boards = self.blackboards()
        step["changed"] = boards != self.boards
        step["bb"] = self.boards = boards
        events.clear()
        self.transitions.clear()
        return step


def difference(case: Case, registry: Registry, level: str) -> str:
    """The first difference between a case's recording and this engine; empty if there is none."""
    expected = case["expected"]
    events.clear()
    try:
        player = Player(case, registry)
    except TreeError as error:
        return "" if "load_error" in expected else f"does not load: {error}"
    if "load_error" in expected:
        return f"loads, but should not: {expected['load_error']}"
    strict = level == "strict"
    if player.nodes() != expected["nodes"]:
        return f"nodes: {player.nodes()} instead of {expected['nodes']}"
    boards = expected["bb_init"]
    found = unequal(player.boards, boards, strict=strict)
    if found:
        return f"after loading: {found}"
    for want, got in zip_longest(expected["trace"], player.trace()):
        if want is None or got is None:
            return f"{'more' if want is None else 'fewer'} steps than the {len(expected['trace'])} of the recording"
        boards = want.get("bb", boards)
        found = step_difference(want, got, boards, strict=strict)
        if found:
            return f"tick {want.get('k', 'halt')}: {found}"
    return ""


def unequal(got: list[Any], want: list[Any], *, strict: bool) -> str:
    mine, theirs = (got, want) if strict else (got[:1], want[:1])
    return "" if mine == theirs else f"bb: {mine} instead of {theirs}"


def step_difference(want: dict[str, Any], got: dict[str, Any], boards: list[Any], *, strict: bool) -> str:
    if ("exc" in want) != ("exc" in got):
        return f"exception: {got.get('exc', 'none')} instead of {want.get('exc', 'none')}"
    for key, default in (("root", None), ("halt", None), ("st", ""), ("ev", []), *((("tr", ""),) if strict else ())):
        if got.get(key, default) != want.get(key, default):
            return f"{key}: {got.get(key, default)} instead of {want.get(key, default)}"
    return unequal(got["bb"], boards, strict=strict)


def replayed(case: Case, registry: Registry, level: str) -> str:
    """As `difference`; a bug of the engine is a difference of this case and does not keep the others from running."""
    try:
        return difference(case, registry, level)
    except BUGS as error:
        return f"{type(error).__name__}: {error}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", type=Path, nargs="?", default=HERE / "cases.jsonl")
    parser.add_argument("--level", default="required", help=" or ".join(LEVELS))
    arguments = parser.parse_args()
    try:
        if arguments.level not in LEVELS:
            raise BadCases(f"there is no level {arguments.level!r}: use {' or '.join(LEVELS)}")
        cases = read_cases(arguments.cases)
    except BadCases as error:
        sys.stderr.write(f"conformance: {error}\n")
        return 2
    registry = scripted_registry()
    failed = 0
    for case in cases:
        found = replayed(case, registry, arguments.level)
        if found:
            failed += 1
            sys.stdout.write(f"{case['id']}: {' '.join(found.split())}\n")
    sys.stdout.write(f"{len(cases) - failed} passed, {failed} failed\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
