"""Ticks of runs that took longer than LATE, as the scheduler counts them."""

from __future__ import annotations

import time

from bench.rig.costs import counted
from tms_config.processes import Process

LATE = 0.25  # s; a bucket of tms_ts_tick_seconds


class Ticks:
    """Looks often: what has grown since the last look happened then."""

    def __init__(self, scheduler: Process) -> None:
        self._scheduler = scheduler
        self._last: float | None = None
        self.late: list[tuple[float, float]] = []  # when, s since 1970, and how many

    def look(self) -> None:
        try:
            now = self._count()
        except OSError:  # it was killed
            self._last = None
            return
        if self._last is not None and now > self._last:
            self.late.append((time.time(), now - self._last))
        self._last = now

    def _count(self) -> float:
        found = counted(self._scheduler)
        return found["tms_ts_tick_seconds_count"] - found[f"tms_ts_tick_seconds_bucket_{LATE}"]
