"""What processes cost: time to be ready, memory, an idle core. The floor is a bare rclpy node beside them.

Of the hungriest process, which is a gateway, it is a bare node that does nothing but hear the same machine.

A site with one excavator, two dump trucks and every subtask of theirs; the first 40 processes are timed until they are
ready. Then all are idle: the machines tell their state and the metrics are scraped as Prometheus does. The stand-ins of
machines and the embedded store count for neither memory nor the idle core, since a site has none. The floor of all
together are bare nodes that do nothing, of which as many as there are gateways hear a machine each.
"""

from __future__ import annotations

import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterable, Sequence
from pathlib import Path

from bench.rig.costs import pss
from bench.rig.mesh import LIMIT, Rig, at, rig, until
from bench.runner import Figure
from tms_config.processes import Process, table
from tms_host.supervisor import Supervisor
from tms_ros.node import Ros
from tms_runtime.metrics import unready

MACHINES = {"zx200": {"model": "zx200"}, "ic120_1": {"model": "ic120"}, "ic120_2": {"model": "ic120"}}
SETTLE, WATCH = 5.0, 15.0  # s; the second is also the time between Prometheus' scrapes
USUAL = 0.3  # s that a bare node needs to start on a usual PC
FLEET = "floor: as many bare action servers, forked at once, until a later node knows them"
MANY, READY = 40, 12.0  # processes, and s until they are ready
SHARE = 0.6  # of what as many bare nodes take together that hear the same
SINGLE = 5  # subtasks that are started, and restarted, one at a time


def measure() -> Iterable[Figure]:
    with rig(machines=MACHINES, sim={"speed": 1.0}) as own:
        rows = [row for row in table(own.site) if row.ours]
        with own.beside("node") as (_, bare_start):  # before anything else runs
            pass
        with own.beside("fleet", str(MANY), "acting") as (_, fleet_start):
            fleet_start += own.bare("find", str(MANY))[0] / 1000
        begun = time.perf_counter()
        program = Path(sys.executable).with_name("tms")  # as people start it: it has to load its libraries, too
        subprocess.run([program, "up"], capture_output=True, timeout=LIMIT, check=True)
        first = time.perf_counter() - begun
        border = own.site.border("ic120_1")
        topics = [f"/ic120_1/{topic}" for topic in (border.joint_states, border.odom)]
        with own.beside("node") as (bare, _), own.beside("hear", *topics) as (hearing, _):
            subtasks = [row for row in rows if row.action]
            with own.node() as ros:
                yield from _starts(own, ros, subtasks[:SINGLE], bare_start)
            more = MANY - len(rows) + len(subtasks)  # subtasks beside what `make up` has started
            many = first + _start_all(own, subtasks[:more])
            yield Figure("`make up` until ready", "s", first, 15.0, bare_start, usual_floor=USUAL)
            yield Figure(f"{MANY} processes ready", "s", many, READY, fleet_start, note=FLEET)
            _start_all(own, subtasks[more:])
            yield from _costs(own, rows, bare, hearing)


def _starts(own: Rig, ros: Ros, subtasks: list[Process], bare: float) -> Iterable[Figure]:
    """From the order until a client that was there before sees the subtask's action server. They are stopped again."""
    supervisor = Supervisor(own.site)
    started = sorted(_until_seen(own, ros, supervisor, "start", row) for row in subtasks)
    again = sorted(_until_seen(own, ros, supervisor, "restart", row) for row in subtasks)
    for row in subtasks:
        supervisor.control("stop", row.full)
    yield Figure("a subtask started, slowest of 5", "s", started[-1], 1.5, bare, usual_floor=USUAL)
    yield Figure("a subtask restarted, slowest of 5", "s", again[-1], 0.5, bare, usual_floor=USUAL)


def _until_seen(own: Rig, ros: Ros, supervisor: Supervisor, order: str, row: Process) -> float:
    from tms_msg_ts.action import LeafNodeBase

    peer = ros.peer(LeafNodeBase, f"/{row.machine}/{row.action}")
    begun = time.perf_counter()
    supervisor.control(order, row.full)  # a process that is restarted has ended when this returns
    until(lambda: unready(row) is None and peer.ready(), f"{row.full} ready")
    return time.perf_counter() - begun


def _start_all(own: Rig, rows: list[Process]) -> float:
    supervisor, begun = Supervisor(own.site), time.perf_counter()
    for row in rows:
        supervisor.control("start", row.full)
    until(lambda: all(unready(row) is None for row in rows), "all processes ready", every=0.2)  # they need the PC
    return time.perf_counter() - begun


def _costs(own: Rig, rows: list[Process], bare: int, hearing: int) -> Iterable[Figure]:
    pids = {row.name: row.pid for row in Supervisor(own.site).processes()}
    wanted = {pids[row.full]: row for row in rows if row.group != "sim"}
    time.sleep(SETTLE)
    idle = _idle([*wanted, bare, hearing], rows)
    floor, received = max(idle.pop(bare), 0.01), idle.pop(hearing)
    memory, bare_memory = {pid: pss(pid) for pid in wanted}, pss(bare)
    largest, hungriest = (max(found, key=lambda pid: found[pid]) for found in (memory, idle))
    count, total, weight = len(wanted), sum(idle.values()), sum(memory.values())
    yield Figure("memory (PSS), largest process", "MB", memory[largest], 60.0, bare_memory, note=wanted[largest].full)
    yield Figure("memory (PSS), mean", "MB", weight / count, 60.0, bare_memory)
    yield Figure("idle, hungriest process", "% core", idle[hungriest], 1.2, received, note=_shares(idle, wanted))
    subtasks = sorted(idle[pid] for pid, row in wanted.items() if row.action)
    yield Figure("idle, a subtask (p50)", "% core", at(0.5, subtasks), 1.0, floor)
    least = floor * count + received * 2 * len(MACHINES)  # each machine is heard by its gateway and by tms:sp
    told = f"{total:.1f} of {least:.1f} % of a core"
    share = (floor * count + (received - floor) * len(MACHINES)) / least
    yield Figure(f"idle, all {count}, of as many bare nodes", "", total / least, SHARE, share, note=told)


def _shares(idle: dict[int, float], rows: dict[int, Process]) -> str:
    """The largest shares by name."""
    first = sorted(((share, rows[pid].full) for pid, share in idle.items()), reverse=True)[:10]
    return ", ".join(f"{name} {share:.1f}" for share, name in first)


def _idle(pids: Sequence[int], rows: list[Process]) -> dict[int, float]:
    """Percent of one core that each process takes, with one scrape of everybody's metrics."""

    def used() -> dict[int, float]:
        return {pid: time.clock_gettime(_clock_of(pid)) for pid in pids}

    before, begun = used(), time.perf_counter()
    for row in rows:
        with urllib.request.urlopen(f"http://{row.address}:{row.port}/metrics", timeout=5) as answer:
            answer.read()
    time.sleep(WATCH - (time.perf_counter() - begun))
    after, passed = used(), time.perf_counter() - begun
    return {pid: 100 * (after[pid] - before[pid]) / passed for pid in pids}


def _clock_of(pid: int) -> int:
    """The clock of a process's processor time (clock_getcpuclockid(3)); /proc tells it in steps of 10 ms only."""
    return (~pid << 3) | 2  # CPUCLOCK_SCHED
