"""Processor time and memory of processes, for the console."""

import psutil

from tms_config.clock import monotonic


class Usage:
    """Keeps the processor time of each process at the last call."""

    def __init__(self) -> None:
        self._before: dict[int, tuple[float, float]] = {}  # pid -> when, s of processor time

    def of(self, pid: int) -> tuple[float, int]:
        """(% of one core since the last call, bytes in RAM); zeros for a process that has ended."""
        try:
            process = psutil.Process(pid)
            with process.oneshot():
                times = process.cpu_times()
                memory = int(process.memory_info().rss)
        except (psutil.NoSuchProcess, psutil.AccessDenied):
            self._before.pop(pid, None)
            return 0.0, 0
        now, used = monotonic(), times.user + times.system
        then, before = self._before.get(pid, (now, used))
        self._before[pid] = now, used
        return (used - before) / (now - then) * 100 if now > then else 0.0, memory

    def keep(self, pids: set[int]) -> None:
        """Forget all processes but these."""
        self._before = {pid: seen for pid, seen in self._before.items() if pid in pids}
