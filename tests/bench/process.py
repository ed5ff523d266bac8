"""What processes cost: time to be ready, memory, an idle core. The floor is a bare rclpy node beside them.

40 processes: a site with one excavator, two dump trucks and every subtask of theirs started. The stand-ins of machines
and the embedded store count for neither memory nor the idle core, since a site has none.
"""

from __future__ import annotations

import time
from collections.abc import Iterable

import psutil

from bench.rig.mesh import Rig, at, rig, until
from bench.runner import Figure
from tms_cli.mesh import unready, up
from tms_core.processes import Process, table
from tms_host.supervisor import Supervisor

MACHINES = {"zx200": {"model": "zx200"}, "ic120_1": {"model": "ic120"}, "ic120_2": {"model": "ic120"}}
SETTLE, WATCH = 5.0, 10.0  # s
RESTARTS = 5


def measure() -> Iterable[Figure]:
    with rig(machines=MACHINES, sim={"speed": 1.0}) as own:
        rows = [row for row in table(own.site) if row.name != "store"]
        up(own.site)
        first = until(lambda: _ready(own, [row for row in rows if row.autostart]), "mesh ready")
        supervisor = Supervisor(own.site)
        begun = time.perf_counter()
        for row in rows:
            if not row.autostart:
                supervisor.control("start", row.full)
        until(lambda: _ready(own, rows), "all processes ready")
        rest = time.perf_counter() - begun
        subtask = next(row for row in rows if row.action)
        back = sorted(_restart(own, supervisor, subtask) for _ in range(RESTARTS))
        with own.beside("node") as (bare, bare_start):
            time.sleep(SETTLE)
            pids = {row.name: row.pid for row in supervisor.processes() if row.pid}
            wanted = [pids[row.full] for row in rows if row.group != "sim"]
            idle = _idle([*wanted, bare])
            floor = max(idle.pop(bare), 0.01)
            memory, bare_memory = [_pss(pid) for pid in wanted], _pss(bare)
        count = len(rows)
        yield Figure("mesh ready", "s", first, 15.0, bare_start)
        yield Figure(f"{count} ready", "s", first + rest, 15.0, bare_start)
        yield Figure("restart p50", "s", at(0.5, back), 1.0, bare_start)
        yield Figure("memory, largest", "MB", max(memory), 60.0, bare_memory)
        yield Figure("memory, mean", "MB", sum(memory) / len(memory), 60.0, bare_memory)
        yield Figure("idle, largest", "%", max(idle.values()), 1.0, floor)
        yield Figure(f"idle, {len(wanted)}", "%", sum(idle.values()), 10.0, floor)


def _ready(own: Rig, rows: list[Process]) -> bool:
    return all(unready(own.site, row) is None for row in rows)


def _restart(own: Rig, supervisor: Supervisor, row: Process) -> float:
    """Seconds from the order to start until the subtask is ready."""
    supervisor.control("stop", row.full)
    begun = time.perf_counter()
    supervisor.control("start", row.full)
    until(lambda: unready(own.site, row) is None, f"{row.full} ready")
    return time.perf_counter() - begun


def _idle(pids: list[int]) -> dict[int, float]:
    """Percent of one core that each process takes."""

    def used() -> dict[int, float]:
        return {pid: sum(psutil.Process(pid).cpu_times()[:2]) for pid in pids}

    before, begun = used(), time.perf_counter()
    time.sleep(WATCH)
    after, passed = used(), time.perf_counter() - begun
    return {pid: 100 * (after[pid] - before[pid]) / passed for pid in pids}


def _pss(pid: int) -> float:
    """MB of a process; what it shares counts for its part."""
    return float(psutil.Process(pid).memory_full_info().pss) / 1e6
