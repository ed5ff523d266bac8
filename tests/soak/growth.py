"""What a long run calls growth: of the memory, handles and threads of a process, from its first third to its last."""

from __future__ import annotations

import statistics
import time
from collections import defaultdict
from dataclasses import dataclass

import psutil

from tms_host.supervisor import Supervisor

WARM = 600.0  # s until caches are full, before which nothing is called growth
YOUNG = 30.0  # s in which a process is not looked at: it still loads what it needs
SLACK = {"memory": 3.0, "handles": 2.0, "threads": 2.0}  # MB, count, count: noise of a process that does not grow
PART = 0.03  # of the memory, in addition
STORE = "tms:store"  # a site has none: it stands for MongoDB


@dataclass(frozen=True)
class Sample:
    """What one process holds."""

    memory: float  # MB of its own
    handles: float
    threads: float


Samples = dict[str, list[Sample]]


class Growth:
    """Looks at all processes now and then, and notes which began anew."""

    def __init__(self, supervisor: Supervisor) -> None:
        self._supervisor = supervisor
        self._pids: dict[str, int] = {}
        self._begun = time.monotonic()
        self.samples: Samples = defaultdict(list)
        self.restarted: list[tuple[float, str]] = []  # when, s since 1970, and which

    def look(self) -> None:
        for row in self._supervisor.processes():
            if not row.pid or row.name == STORE:
                continue
            if self._pids.get(row.name, row.pid) != row.pid:
                self.restarted.append((time.time(), row.name))
            self._pids[row.name] = row.pid
            if time.monotonic() > self._begun + WARM:
                self._take(row.name, row.pid)

    def _take(self, name: str, pid: int) -> None:
        try:
            sample = _sample(pid)
        except psutil.NoSuchProcess:
            return  # it was killed just now
        if sample is not None:
            self.samples[name].append(sample)


def _sample(pid: int) -> Sample | None:
    process = psutil.Process(pid)
    if time.time() - process.create_time() < YOUNG:
        return None
    return Sample(process.memory_full_info().uss / 1e6, process.num_fds(), process.num_threads())


def _ends(rows: list[Sample], what: str) -> tuple[float, float]:
    """Medians of the first third (but the very first, before caches are warm) and of the last."""
    third = max(1, len(rows) // 3)
    first, last = rows[1 : third + 1] or rows[:1], rows[-third:]
    before, after = (statistics.median(getattr(row, what) for row in part) for part in (first, last))
    return before, after


def table(samples: Samples) -> str:
    """What each process held in the first third of the time and in the last."""
    lines = [f"{'process':<40}{'memory [MB]':>18}{'handles':>14}{'threads':>14}"]
    for name, rows in sorted(samples.items()):
        memory, handles, threads = (_ends(rows, what) for what in SLACK)
        lines.append(
            f"{name:<40}{memory[0]:>8.1f} -> {memory[1]:<6.1f}{handles[0]:>6.0f} -> {handles[1]:<4.0f}"
            f"{threads[0]:>6.0f} -> {threads[1]:<4.0f}"
        )
    return "\n".join(lines)


def growth(samples: Samples) -> list[str]:
    """What grew from the first third of the samples to the last."""
    found = []
    for name, rows in sorted(samples.items()):
        for what, slack in SLACK.items():
            before, after = _ends(rows, what)
            allowed = before + slack + (PART * before if what == "memory" else 0)
            if after > allowed:
                found.append(f"{name}: {what} grew from {before:.1f} to {after:.1f}, allowed are {allowed:.1f}")
    return found
