"""Metrics of this PC's processes, disk and clock, read when Prometheus asks."""

import ctypes
import ctypes.util
import os
import shutil
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import psutil
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from tms_config.clock import unix_time
from tms_host.supervisor import Running

UNSYNCHRONISED = 0x40  # STA_UNSYNC of adjtimex(2)
NANOSECONDS = 0x2000  # STA_NANO

PER_PROGRAM = {
    "cpu_seconds": "CPU time used since its start",
    "resident_memory_bytes": "Memory in RAM",
    "open_fds": "Open file descriptors",
    "start_time_seconds": "When it was started",
}


@dataclass(frozen=True)
class Clock:
    """The kernel's figures on this PC's clock."""

    synchronised: bool
    error: float  # s, bound that the time daemon gives
    offset: float  # s, still to be corrected


class _Timex(ctypes.Structure):
    _fields_ = [
        ("modes", ctypes.c_uint), ("offset", ctypes.c_long), ("freq", ctypes.c_long), ("maxerror", ctypes.c_long),
        ("esterror", ctypes.c_long), ("status", ctypes.c_int), ("rest", ctypes.c_byte * 256),
    ]  # fmt: skip


def clock() -> Clock | None:
    """State of the clock, from adjtimex(2) as chrony and ntpd set it; None where the kernel does not report it."""
    facts = _Timex()
    libc = ctypes.CDLL(ctypes.util.find_library("c"), use_errno=True)
    if libc.adjtimex(ctypes.byref(facts)) < 0:  # modes 0 only reads
        return None
    unit = 1e-9 if facts.status & NANOSECONDS else 1e-6
    return Clock(not facts.status & UNSYNCHRONISED, facts.maxerror * 1e-6, facts.offset * unit)


class HostCollector(Collector):
    """Collects at every scrape; `update` sets supervisord's last answer."""

    def __init__(self, state: Path, read_clock: Callable[[], Clock | None] = clock) -> None:
        self._state, self._clock = state, read_clock
        self._rows: list[Running] = []
        self._restarts: dict[str, int] = {}
        self._lock = threading.Lock()

    def update(self, rows: list[Running], restarts: dict[str, int]) -> None:
        """Take supervisord's answer, from the thread that asks it."""
        with self._lock:
            self._rows, self._restarts = rows, dict(restarts)

    def collect(self) -> Iterator[Metric]:
        """All families of metrics; those from /proc leave out a process that has just ended."""
        with self._lock:
            rows, restarts = self._rows, self._restarts
        up = GaugeMetricFamily("tms_host_program_up", "1 while supervisord runs it", labels=["program"])
        state = GaugeMetricFamily("tms_host_program_state", "1 for its state", labels=["program", "state"])
        again = CounterMetricFamily("tms_host_program_restarts", "Restarts since tms:host started", labels=["program"])
        for row in rows:
            up.add_metric([row.name], row.state == "RUNNING")
            state.add_metric([row.name, row.state], 1)
            again.add_metric([row.name], restarts.get(row.name, 0))
        yield from (up, state, again)
        yield from self._programs(rows)
        yield from self._pc()

    def _programs(self, rows: list[Running]) -> Iterator[Metric]:
        kinds = {key: CounterMetricFamily if key == "cpu_seconds" else GaugeMetricFamily for key in PER_PROGRAM}
        found = {
            key: kind(f"tms_host_program_{key}", PER_PROGRAM[key], labels=["program"]) for key, kind in kinds.items()
        }
        for row in rows:
            for key, value in _measured(row.pid).items():
                found[key].add_metric([row.name], value)
        yield from found.values()

    def _pc(self) -> Iterator[Metric]:
        disk = shutil.disk_usage(self._state)
        yield GaugeMetricFamily("tms_host_disk_free_bytes", "Free where state and logs are", disk.free)
        yield GaugeMetricFamily("tms_host_disk_size_bytes", "Size of that disk", disk.total)
        yield GaugeMetricFamily("tms_host_cpus", "Cores", os.cpu_count() or 1)
        yield GaugeMetricFamily("tms_host_load1", "Processes that run or want to, 1 minute", os.getloadavg()[0])
        yield GaugeMetricFamily(
            "tms_host_memory_available_bytes", "Memory to be had", psutil.virtual_memory().available
        )
        yield GaugeMetricFamily("tms_host_clock_seconds", "This PC's clock at the scrape", unix_time())
        facts = self._clock()
        if facts is not None:
            yield GaugeMetricFamily("tms_host_clock_synchronised", "1 while a daemon keeps it", facts.synchronised)
            yield GaugeMetricFamily("tms_host_clock_error_seconds", "Largest error, as the kernel says", facts.error)
            yield GaugeMetricFamily("tms_host_clock_offset_seconds", "Offset still to be corrected", facts.offset)


def _measured(pid: int) -> dict[str, float]:
    if not pid:
        return {}
    try:
        process = psutil.Process(pid)
        with process.oneshot():
            times = process.cpu_times()
            return {
                "cpu_seconds": times.user + times.system,
                "resident_memory_bytes": process.memory_info().rss,
                "open_fds": process.num_fds(),
                "start_time_seconds": process.create_time(),
            }
    except (psutil.NoSuchProcess, psutil.AccessDenied):
        return {}
