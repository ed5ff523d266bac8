"""Ticks of runs that took longer than LATE, as the scheduler counts them."""

from __future__ import annotations

import time
import urllib.error
import urllib.request

from prometheus_client.parser import text_string_to_metric_families

from tms_config.processes import Process

LATE = 0.25  # s; a bucket of tms_ts_tick_seconds


class Ticks:
    """Looks often: what has grown since the last look happened then."""

    def __init__(self, scheduler: Process) -> None:
        self._url = f"http://{scheduler.address}:{scheduler.port}/metrics"
        self._last: float | None = None
        self.late: list[tuple[float, float]] = []  # when, s since 1970, and how many

    def look(self) -> None:
        try:
            now = self._count()
        except (urllib.error.URLError, OSError):  # it was killed
            self._last = None
            return
        if self._last is not None and now > self._last:
            self.late.append((time.time(), now - self._last))
        self._last = now

    def _count(self) -> float:
        with urllib.request.urlopen(self._url, timeout=5) as answer:
            families = text_string_to_metric_families(answer.read().decode())
        ticks = next(family for family in families if family.name == "tms_ts_tick_seconds")
        by_limit = {each.labels["le"]: each.value for each in ticks.samples if each.name.endswith("_bucket")}
        return by_limit["+Inf"] - by_limit[str(LATE)]
