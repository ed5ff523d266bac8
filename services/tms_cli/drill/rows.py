"""What is hit when, what was seen, and the figures over all of it. Pure logic."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

KILL, FREEZE, RESTART = "SIGKILL", "SIGSTOP", "restart"
QUICK_LEAVES = 3
HUNG, LEFT_OUT = "hung", "left out"


@dataclass(frozen=True)
class Case:
    """One trial: a process, the leaf that is RUNNING, and what is done to the process."""

    process: str
    leaf: int  # 0 is the first leaf of the task
    how: str
    stops: bool  # whether the machine must stop: the process stands behind the motion


@dataclass
class Row:
    """What was seen of one case; times in s, None for what did not happen."""

    process: str
    node: str
    how: str
    machine: str
    must_stop: bool
    kill_to_stop_s: float | None = None  # until the machine was told to stop
    stop_s: float | None = None  # from then until it stood
    travel: float = 0.0  # rad, from the kill to the stand-still
    confirmed: bool = False
    back_s: float | None = None
    outcome: str = HUNG
    receipt: str = ""  # what the gateway says of the stop

    @property
    def ok(self) -> bool:
        """Whether everything went as deploy/FAILURES.md says."""
        return self.confirmed and self.outcome not in (HUNG, LEFT_OUT) and self.back_s is not None


def cases(movers: Sequence[str], subtasks: Sequence[str], others: Sequence[str], quick: bool) -> list[Case]:
    """Every (process, leaf) pair with SIGKILL, and each process once frozen and once restarted.

    `movers` stand behind every motion; `subtasks` has the process behind each leaf, in order.
    """
    chosen = subtasks[:QUICK_LEAVES] if quick else subtasks
    common = [(name, True) for name in movers] + [(name, False) for name in others]
    kills = [
        Case(name, leaf, KILL, stops)
        for leaf, subtask in enumerate(chosen)
        for name, stops in [(subtask, True), *common]
    ]
    used = [(subtasks[0], True), *common][: None if not quick else len(movers) + 1]
    gentle = [
        Case(name, number % len(chosen) if name != subtasks[0] else 0, how, stops)
        for number, (name, stops) in enumerate(used)
        for how in (FREEZE, RESTART)
    ]
    return kills + gentle


def choose(todo: Sequence[Case], leaf: int, fresh: bool) -> Case | None:
    """The next case while a leaf is RUNNING; a process behind the motion is hit only when that is `fresh`."""
    fitting = [case for case in todo if case.leaf == leaf and (fresh or not case.stops)]
    return next((case for case in fitting if case.stops), fitting[0] if fitting else None)


def percentile(values: Sequence[float], share: float) -> float | None:
    """The value that `share` of all do not exceed, None without values."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)] if ordered else None


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """The document of --json."""
    tried = [row for row in rows if row.outcome != LEFT_OUT]
    told = [row.kill_to_stop_s for row in tried if row.kill_to_stop_s is not None and row.how != RESTART]
    stops = [row.stop_s for row in tried if row.stop_s is not None]
    backs = [row.back_s for row in tried if row.back_s is not None and row.how == KILL]
    return {
        "kills": sum(row.how == KILL for row in tried),
        "trials": len(tried),
        "left_out": len(rows) - len(tried),
        "unconfirmed": sum(not row.confirmed for row in tried),
        "not_back": sum(row.back_s is None for row in tried),
        "hung": sum(row.outcome == HUNG for row in tried),
        "stop_p50_s": percentile(stops, 0.5),
        "stop_p99_s": percentile(stops, 0.99),
        "kill_to_stop_p50_s": percentile(told, 0.5),
        "kill_to_stop_p99_s": percentile(told, 0.99),
        "kill_to_stop_max_s": max(told, default=None),
        "back_p50_s": percentile(backs, 0.5),
        "back_max_s": max(backs, default=None),
        "rows": [{**asdict(row), "ok": row.ok} for row in rows],
    }
