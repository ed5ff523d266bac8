"""Kills, freezes and restarts the processes of a stop, and waits until they work again."""

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence

import psutil

from tms_cli import mesh
from tms_cli.drill.plan import MC, RC, RP, SUBTASK, How, StopScenario
from tms_cli.drill.stand_ins import GROUP, NICE
from tms_cli.reasons import NotRunning
from tms_config.clock import sleep, unix_time
from tms_config.config import Site
from tms_config.processes import find, table
from tms_host.supervisor import Supervisor
from tms_reason.errors import TmsError
from tms_runtime import metrics
from tms_runtime.priority import come_first
from tms_runtime.reasons import PortSilent, ProcessStarting

FROZEN = 2.0  # s
BACK_LIMIT = 40.0  # s
CHECK_PERIOD = 0.1  # s
OF_MACHINE = (RC, RP, MC, SUBTASK)


class Hits:
    """Used by one thread at a time: supervisord's client is not thread safe."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self._there = {row.full for row in table(site)}
        self._thaw: subprocess.Popen[bytes] | None = None

    def names(self, stop: StopScenario, subtasks: Mapping[str, str]) -> list[str]:
        """The processes that a stop hits. `subtasks`: for each hit machine, the one of its present leaf."""
        found = [process for process in stop.processes if process not in OF_MACHINE]
        for machine, subtask in subtasks.items():
            found += [f"{machine}:{name}" for name in (RC, RP, MC) if name in stop.processes]
            found += [subtask] if SUBTASK in stop.processes else []
        return [name for name in found if name in self._there]

    def pids(self, names: Sequence[str]) -> dict[str, int]:
        """The pids of processes; read before the hit, so that all signals are sent together.

        Raises:
            TmsError: one of them does not run.
        """
        running = self._running()
        missing = [name for name in names if not running.get(name)]
        if missing:
            raise TmsError(NotRunning(tuple(missing)))
        return {name: running[name] for name in names}

    def all_names(self, subtasks: Sequence[str]) -> tuple[str, ...]:
        """The processes that a power cut ends; the subtasks of the present leaves were started on demand."""
        return (*(row.full for row in table(self._site) if row.autostart and row.group != GROUP), *subtasks)

    def everything(self) -> list[int]:
        """The pids of all processes that a power cut ends, supervisord first."""
        top = psutil.Process(Supervisor(self._site).pid())
        return [top.pid, *(child.pid for child in top.children(recursive=True))]

    def hit(self, how: How, pids: Sequence[int]) -> float:
        """Send the signals; returns the time of the first one (s since 1970)."""
        at = unix_time()
        _signal(signal.SIGSTOP if how is How.FREEZE else signal.SIGKILL, pids)
        if how is How.FREEZE:
            self._thaw = subprocess.Popen(
                [sys.executable, "-m", "tms_cli.drill.thaw", str(at + FROZEN), *map(str, pids)]
            )
            come_first(NICE, {self._thaw.pid})
        return at

    def back(self, how: How, pids: Mapping[str, int], hit: float, started: dict[str, float]) -> float | None:
        """Wait until all processes work again; returns seconds from the hit, None after BACK_LIMIT.

        `started` gets when they were seen to have begun, s since 1970.
        """
        waiting = dict(pids)
        if self._thaw is not None:
            self._thaw.wait()
            self._thaw = None
        while unix_time() - hit < BACK_LIMIT:
            running = self._running()
            for name, before in list(waiting.items()):
                pid = running.get(name, 0)
                if not pid or (how is not How.FREEZE and pid == before):
                    continue
                started.setdefault(name, unix_time())
                if self._works(name):
                    del waiting[name]
            if not waiting:
                return unix_time() - hit
            sleep(CHECK_PERIOD)
        return None

    def power_on(self, pids: Sequence[int], hit: float, started: dict[str, float]) -> float | None:
        """Start the mesh again after a power cut, when all processes have ended; returns as `back`."""
        while any(map(psutil.pid_exists, pids)) and unix_time() - hit < BACK_LIMIT:
            sleep(CHECK_PERIOD)
        mesh.up(self._site, without=GROUP)
        return self.back(How.POWER, dict.fromkeys(self.all_names([]), 0), hit, started)

    def _running(self) -> dict[str, int]:
        return {row.name: row.pid for row in Supervisor(self._site).processes()}

    def _works(self, name: str) -> bool:
        """Whether a process works. For a machine's process any answer is enough: the machine may make it unready."""
        row = find(self._site, name)
        reason = metrics.unready(row) if row.ours else None
        return reason is None or (row.machine is not None and reason not in (PortSilent(name), ProcessStarting()))


def power_off(pids: Sequence[int]) -> float:
    """Kill all processes, supervisord first in `pids`; returns the time of the first signal (s since 1970).

    Supervisord is killed last: at its end, all others would end in order, and stop their machines. It is frozen first,
    else it would start them again.
    """
    at, (top, *others) = unix_time(), pids
    _signal(signal.SIGSTOP, [top])
    _signal(signal.SIGKILL, [*others, top])
    return at


def _signal(number: signal.Signals, pids: Sequence[int]) -> None:
    for pid in pids:
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            continue  # it had ended, or was replaced, in the meantime
