"""How large a site one scheduler carries: 1, 5, 20 and 50 machines with four subtasks each, up to 20 runs at once.

The scheduler, the database and the store are the real ones; machines, gateways and subtasks are at the level of
messages (rig/crowd.py), since 50 times their processes would not fit on a PC. The group `stop` has 20 real gateways.
A goal takes 10 s, as a motion of a machine does: 50 machines ask for 5 hand-overs a second. The floor is the same site
with one machine; that of the memory is a bare node with as many ends of the same names and types beside the same
machines. Of two schedulers, that share the machines, the figures are those of the one that does worse.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil
from rclpy.node import Node

from bench.rig import dispatcher
from bench.rig.costs import counted, pss
from bench.rig.dispatcher import END_LIMIT, LIMIT, SUBTASKS
from bench.rig.mesh import Rig, rig
from bench.runner import Figure
from tms_config.processes import Process, find

SIZES = ((1, 1), (5, 1), (20, 1), (20, 2), (50, 1))  # machines, schedulers
RUNS = 20  # at most; a run moves a machine at least
SERVICES: dict[str, object] = {"db": {}, "ts": {}}
FIRST, SECOND = "cps", "east"  # PCs of a site of two schedulers
A_PROCESS = 10  # machines in one process of the crowd
SETTLE, WATCH = 2.0, 12.0  # s
MEMORY = 120.0  # MB
SLOW = 0.25  # s; p99 of the hand-overs is below it if at most 1 % are above it
CROWD, DRIVEN, FORKS = (Path(__file__).parent / "rig" / name for name in ("crowd.py", "driven.py", "forks.py"))
FOUND = 3.0  # s between two looks at the memory of a node that finds all others; it grows meanwhile
LOOKS, SAME = 20, 1.01  # at most; the ratio of two looks
GONE = 6.0  # s after which discovery has dropped a process that was killed


@dataclass(frozen=True)
class Cost:
    """Of one size."""

    late: float  # % of the ticks
    handed_over: float  # ms, mean
    slow: float  # % of the hand-overs that took longer than SLOW
    received: float  # ms from the press to the last machine
    cancelled: float  # ms from the press to the last goal that was asked to end
    left: int  # runs that have not ended END_LIMIT after the stop
    cpu: float  # % of a core, a scheduler's
    memory: float  # MB, a scheduler's
    bare: float | None  # MB, of a bare node with the same ends, where the scheduler's are more than MEMORY


def measure() -> Iterable[Figure]:
    least: Cost | None = None
    for size, count in SIZES:
        cost = _cost(size, count)
        least = least or cost
        name = f"{size} machines, {min(size, RUNS)} runs" if count == 1 else f"{size} machines, two schedulers"
        note = f"hand-over {cost.handed_over:.1f} ms"
        yield Figure(f"{name}: late ticks", "%", cost.late, 1.0, max(least.late, 0.01), note=note)
        yield Figure(f"  hand-overs over {1000 * SLOW:.0f} ms", "%", cost.slow, 1.0)
        yield Figure("  processor time of tms:ts", "% core", cost.cpu, 80.0, least.cpu)
        yield Figure("  stop heard by the last machine", "ms", cost.received, 50.0, least.received, usual_floor=10.0)
        yield Figure("  stop until the last goal ends", "ms", cost.cancelled, 700.0, least.cancelled)
        yield Figure(f"  runs left after {END_LIMIT:.0f} s", "", float(cost.left), 0.5)
        yield Figure("  memory (PSS) of tms:ts", "MB", cost.memory, MEMORY, cost.bare)


def _cost(size: int, count: int) -> Cost:
    names = [f"m{number}" for number in range(size)]
    shares = [names[number::count] for number in range(count)]
    with _site(shares) as own, ExitStack() as beside, ExitStack() as stack:
        pids = {"tms:ts": stack.enter_context(processes(own, dict(os.environ), "tms:store", "tms:db", "tms:ts"))[-1]}
        if count > 1:
            second = f"tms:ts_{SECOND}"
            pids[second] = stack.enter_context(processes(own, own.mesh.environment_of(SECOND), second))[-1]
        crowds = beside.enter_context(machines_of(own, names))
        ros = stack.enter_context(own.node())
        dispatcher.store_records(ros, names)
        calls = dispatcher.start_all(ros, own.site, RUNS)
        time.sleep(SETTLE)
        rows = {find(own.site, name): pid for name, pid in pids.items()}
        late, handed_over, slow, cpu = map(max, zip(*watched(rows), strict=True))
        memory, largest = max((pss(pid), name) for name, pid in pids.items())
        ends = _ends(ros.node, largest.replace(":", "_"))
        received, cancelled = after_press(dispatcher.press(ros, len(crowds)), crowds)
        left = dispatcher.left(calls)
        stack.close()
        bare = _bare(own, ends) if memory > MEMORY else None
        return Cost(late, handed_over, slow, received, cancelled, left, cpu, memory, bare)


def _ends(node: Node, name: str) -> dict[str, list[tuple[str, str]]]:
    """What another node has in DDS, by kind: names and types."""
    graph = {
        "publisher": node.get_publisher_names_and_types_by_node,
        "subscription": node.get_subscriber_names_and_types_by_node,
        "service": node.get_service_names_and_types_by_node,
        "client": node.get_client_names_and_types_by_node,
    }
    return {kind: [(one, types[0]) for one, types in found(name, "/")] for kind, found in graph.items()}


def _bare(own: Rig, ends: dict[str, list[tuple[str, str]]]) -> float:
    """MB of a bare node with these ends."""
    time.sleep(GONE)
    file = Path(own.mesh.state) / "ends.json"
    file.write_text(json.dumps(ends), encoding="utf-8")
    with own.beside("same", str(file)) as (pid, _):
        return _settled(pid)


def _settled(pid: int) -> float:
    """MB of a process whose memory has grown."""
    memory = 0.0
    for _ in range(LOOKS):
        time.sleep(FOUND)
        memory, before = pss(pid), memory
        if memory < SAME * before:
            return memory
    raise TimeoutError(f"the memory of a bare node still grows after {LOOKS * FOUND:.0f} s")


def _site(shares: list[list[str]]) -> AbstractContextManager[Rig]:
    """A site whose schedulers have these machines."""
    machines = {name: {"model": "zx200"} for share in shares for name in share}
    if len(shares) == 1:
        return rig(machines=machines, services=SERVICES)
    pcs = {
        FIRST: {"address": "127.0.0.1", "roles": ["cps", "machine", "sensing", "sim"]},
        SECOND: {"address": "127.0.0.1", "roles": ["scheduler"], "machines": shares[1]},
    }
    return rig(FIRST, machines=machines, services=SERVICES, pcs=pcs)


@contextmanager
def processes(own: Rig, env: dict[str, str], *names: str) -> Iterator[list[int]]:
    """Processes of the mesh; their pids."""
    with _program(own, env, FORKS, *names) as forks:
        assert forks.stdin is not None
        assert forks.stdout is not None
        try:
            yield json.loads(forks.stdout.readline())
        finally:
            forks.stdin.close()
            forks.wait(LIMIT)


@contextmanager
def machines_of(
    own: Rig, names: list[str], kind: Path = CROWD, together: int = A_PROCESS
) -> Iterator[list[subprocess.Popen[str]]]:
    """Machines at the level of messages, or DRIVEN ones, so many in a process; these are ready."""
    with ExitStack() as stack:
        parts = [names[i : i + together] for i in range(0, len(names), together)]
        running = [
            stack.enter_context(_program(own, dict(os.environ), kind, part[0], ",".join(SUBTASKS), *part))
            for part in parts
        ]
        for one in running:
            stack.callback(one.kill)
        for one in running:
            assert one.stdout is not None
            assert one.stdout.readline() == "ready\n"
        yield running


@contextmanager
def _program(own: Rig, env: dict[str, str], path: Path, *words: str) -> Iterator[subprocess.Popen[str]]:
    log = Path(own.mesh.state) / "bench.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    with (
        log.open("a") as errors,
        subprocess.Popen(
            [sys.executable, path, *words],
            env=env,
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
        ) as running,
    ):
        yield running


def watched(rows: Mapping[Process, int]) -> list[tuple[float, float, float, float]]:
    """Of schedulers, in a while, by pid: late ticks [%], mean hand-over [ms], slow ones [%], processor time [%]."""

    def used() -> dict[Process, float]:
        return {row: sum(psutil.Process(pid).cpu_times()[:2]) for row, pid in rows.items()}

    before, cpu, begun = {row: counted(row) for row in rows}, used(), time.perf_counter()
    time.sleep(WATCH)
    after, ended, passed = {row: counted(row) for row in rows}, used(), time.perf_counter() - begun
    return [(*_ticks_and_hand_overs(before[row], after[row]), 100 * (ended[row] - cpu[row]) / passed) for row in rows]


def _ticks_and_hand_overs(before: dict[str, float], after: dict[str, float]) -> tuple[float, float, float]:
    def grown(name: str) -> float:
        return after[f"tms_ts_{name}"] - before[f"tms_ts_{name}"]

    late = 100 * grown("tick_overruns_total") / grown("tick_seconds_count")
    hand_overs = max(1, grown("handover_seconds_count"))
    handed_over = 1000 * grown("handover_seconds_sum") / hand_overs
    return late, handed_over, 100 * (1 - grown(f"handover_seconds_bucket_{SLOW}") / hand_overs)


def after_press(begun: int, crowds: Iterable[subprocess.Popen[str]]) -> tuple[float, float]:
    """ms from the press [ns since 1970] until the last machine has heard it, and the last goal was asked to end."""
    stamps = []
    for crowd in crowds:
        assert crowd.stdout is not None
        stamps += json.loads(crowd.stdout.readline())
    received, ended = ([(stamp - begun) / 1e6 for stamp in column if stamp] for column in zip(*stamps, strict=True))
    assert len(received) == len(stamps), "a machine has not heard the stop"
    return max(received), max(ended, default=0.0)
