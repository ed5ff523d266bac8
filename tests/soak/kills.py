"""Kills one process after the other, and knows what that explains."""

from __future__ import annotations

import itertools
import os
import signal
import time

from tms_host.supervisor import Supervisor

PERIOD = 60.0  # s between two
BACK = 20.0  # s after a kill in which a tick may be late
SEEN = 60.0  # s after a kill in which it is seen that the process has begun anew
KILLED = (
    "zx200:st_zx200_choose_dig_point",
    "zx200:subtask_zx200_excavate_simple",
    "ic120_1:rc",
    "zx200:st_zx200_dig_again_until",
    "zx200:rp",
    "tms:sp",
    "ic120_2:st_ic120_wait_until_loaded",
    "tms:ts",
    "zx200:st_zx200_choose_dump_point",
    "zx200:rc",
    "tms:db",
    "ic120_1:st_ic120_navigate_anywhere_deg",
    "tms:ground",
    "ic120_2:rc",
    "tms:host",
)


class Kills:
    """One after the other, for ever."""

    def __init__(self, supervisor: Supervisor) -> None:
        self._supervisor, self._next = supervisor, itertools.cycle(KILLED)
        self.done: list[tuple[float, str]] = []  # when, s since 1970, and which
        self._restarted: list[tuple[float, str]] = []  # those that the work itself has started anew

    def kill(self) -> str:
        """Kill the next that runs."""
        pids = {row.name: row.pid for row in self._supervisor.processes()}
        name = next(name for name in itertools.islice(self._next, len(KILLED)) if pids.get(name))
        self.done.append((time.time(), name))
        os.kill(pids[name], signal.SIGKILL)
        return name

    def explain_late(self, at: float) -> bool:
        """Whether a tick may have been late at a moment [s since 1970]."""
        return any(0 <= at - when <= BACK for when, _ in self.done)

    def restarted(self, name: str) -> None:
        """Note that the work has started a process anew just now."""
        self._restarted.append((time.time(), name))

    def explain_new(self, at: float, name: str) -> bool:
        """Whether a process may have begun anew before a moment [s since 1970]."""
        return any(0 <= at - when <= SEEN and name == one for when, one in (*self.done, *self._restarted))

    def count(self, name: str) -> int:
        return sum(killed == name for _, killed in self.done)
