"""How large a site one scheduler carries: 1, 5, 20 and 50 machines with four subtasks each, up to 20 runs at once.

The scheduler, the database and the store are the real ones; machines, gateways and subtasks are at the level of
messages (rig/crowd.py), since 50 times their processes would not fit on a PC. The group `stop` has 20 real gateways.
A goal takes 10 s, as a motion of a machine does: 50 machines ask for 5 hand-overs a second. The floor is the same site
with one machine. Of two schedulers, that share the machines, the figures are those of the one that does worse.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil
from prometheus_client.parser import text_string_to_metric_families
from std_msgs.msg import Bool
from tms_msg_db.srv import AddTask, SetParameter
from tms_msg_ts.action import ExecuteTask

from bench.rig.mesh import Rig, rig, until
from bench.runner import Figure
from tms_config.processes import find
from tms_machine.values import to_parameters
from tms_ros.client import Call
from tms_ros.node import Ros
from tms_schedulers.names import own as scheduler_of
from tms_schedulers.names import schedulers

SIZES = ((1, 1), (5, 1), (20, 1), (20, 2), (50, 1))  # machines, schedulers
RUNS = 20  # at most; a run moves a machine at least
SERVICES: dict[str, object] = {"db": {}, "ts": {}}
FIRST, SECOND = "cps", "east"  # PCs of a site of two schedulers
JOINTS = {"boom": -46.0, "swing": 0.0, "arm": 114.0, "bucket": 46.0}  # deg
SUBTASKS = [f"st_zx200_sample_{joint}" for joint in JOINTS]
A_PROCESS = 10  # machines in one process of the crowd
SETTLE, WATCH = 2.0, 12.0  # s
SLOW = 0.25  # s; p99 of the hand-overs is below it if at most 1 % are above it
LIMIT, END_LIMIT = 60.0, 20.0  # s; the second for the runs to end after a stop
CROWD, FORKS = (Path(__file__).parent / "rig" / name for name in ("crowd.py", "forks.py"))
LEAF = '<Action ID="LeafNodeZx200" model_name="{}" record_name="BENCH" subtask_name="{}"/>'


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
        yield Figure("  memory (PSS) of tms:ts", "MB", cost.memory, 120.0, least.memory)


def _cost(size: int, count: int) -> Cost:
    names = [f"m{number}" for number in range(size)]
    shares = [names[number::count] for number in range(count)]
    with _site(shares) as own, ExitStack() as stack:
        pids = {"tms:ts": stack.enter_context(_processes(own, dict(os.environ), "tms:store", "tms:db", "tms:ts"))[-1]}
        if count > 1:
            second = f"tms:ts_{SECOND}"
            pids[second] = stack.enter_context(_processes(own, own.mesh.environment_of(SECOND), second))[-1]
        crowds = [
            stack.enter_context(_crowd(own, names[i], ",".join(SUBTASKS), *names[i : i + A_PROCESS]))
            for i in range(0, size, A_PROCESS)
        ]
        for crowd in crowds:
            assert crowd.stdout is not None
            assert crowd.stdout.readline() == "ready\n"
        ros = stack.enter_context(own.node())
        _store_records(ros, names)
        calls = [call for process, share in zip(pids, shares, strict=True) for call in _start(own, ros, process, share)]
        until(lambda: all(_runs(call) for call in calls), "every run goes", LIMIT)
        time.sleep(SETTLE)
        late, handed_over, slow, cpu = map(max, zip(*_watched(own, pids), strict=True))
        memory = max(psutil.Process(pid).memory_full_info().pss / 1e6 for pid in pids.values())
        received, cancelled = _press(ros, crowds)
        return Cost(late, handed_over, slow, received, cancelled, _left(calls), cpu, memory)


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
def _processes(own: Rig, env: dict[str, str], *names: str) -> Iterator[list[int]]:
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
def _crowd(own: Rig, *words: str) -> Iterator[subprocess.Popen[str]]:
    with _program(own, dict(os.environ), CROWD, *words) as crowd:
        try:
            yield crowd
        finally:
            crowd.kill()


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


def _store_records(ros: Ros, names: list[str]) -> None:
    values = to_parameters({f"zx200_{joint}_goal_pos": angle for joint, angle in JOINTS.items()})

    def stored(name: str) -> bool:
        request = SetParameter.Request(
            model_name=name, record_name="BENCH", type="static", source="bench", create=True, values=values
        )
        return not ros.call(SetParameter, "/tms/db/set_parameter", request, LIMIT).error_code

    until(lambda: stored(names[0]), "the database", LIMIT)
    assert all(stored(name) for name in names[1:])


def _start(own: Rig, ros: Ros, process: str, names: list[str]) -> list[Call]:
    """A scheduler's machines dealt out to its runs, which go on for ever."""
    runs = RUNS // len(schedulers(own.site))
    hands = [names[number::runs] for number in range(min(runs, len(names)))]
    scheduler = ros.peer(ExecuteTask, scheduler_of(own.site, process).named("execute_task"))
    scheduler.wait_ready(LIMIT)
    calls = []
    for hand in hands:
        added = ros.call(AddTask, "/tms/db/add_task", AddTask.Request(task_sequence=_tree(hand)), LIMIT)
        assert not added.error_code, added.error_msg
        calls.append(scheduler.send(ExecuteTask.Goal(task_id=added.task_id, ignore_warnings=True)))
    return calls


def _left(calls: list[Call]) -> int:
    deadline = time.monotonic() + END_LIMIT
    for call in calls:
        call.wait_for(lambda call=call: call.outcome is not None, deadline - time.monotonic())  # type: ignore[misc]
    return sum(call.outcome is None for call in calls)


def _runs(call: Call) -> bool:
    assert call.outcome is None, call.result
    return call.feedback is not None and call.feedback.state == "running"


def _tree(machines: list[str]) -> str:
    """Each machine from subtask to subtask, all of them at once."""
    rows = [
        f"<KeepRunningUntilFailure><Sequence>{''.join(LEAF.format(name, subtask) for subtask in SUBTASKS)}</Sequence>"
        "</KeepRunningUntilFailure>"
        for name in machines
    ]
    inside = (
        rows[0]
        if len(rows) == 1
        else f'<Parallel success_threshold="{len(rows)}" failure_threshold="1">{"".join(rows)}</Parallel>'
    )
    return f'<root main_tree_to_execute="M"><BehaviorTree ID="M">{inside}</BehaviorTree></root>'


def _watched(own: Rig, pids: dict[str, int]) -> list[tuple[float, float, float, float]]:
    """Of each scheduler, in a while: late ticks [%], mean hand-over [ms], slow ones [%], processor time [% core]."""

    def used() -> dict[str, float]:
        return {name: sum(psutil.Process(pid).cpu_times()[:2]) for name, pid in pids.items()}

    before, cpu, begun = {name: _counted(own, name) for name in pids}, used(), time.perf_counter()
    time.sleep(WATCH)
    after, ended, passed = {name: _counted(own, name) for name in pids}, used(), time.perf_counter() - begun
    return [
        (*_ticks_and_hand_overs(before[name], after[name]), 100 * (ended[name] - cpu[name]) / passed) for name in pids
    ]


def _ticks_and_hand_overs(before: dict[str, float], after: dict[str, float]) -> tuple[float, float, float]:
    def grown(name: str) -> float:
        return after[f"tms_ts_{name}"] - before[f"tms_ts_{name}"]

    late = 100 * grown("tick_overruns_total") / grown("tick_seconds_count")
    hand_overs = max(1, grown("handover_seconds_count"))
    handed_over = 1000 * grown("handover_seconds_sum") / hand_overs
    return late, handed_over, 100 * (1 - grown(f"handover_seconds_bucket_{SLOW}") / hand_overs)


def _counted(own: Rig, process: str) -> dict[str, float]:
    row = find(own.site, process)
    with urllib.request.urlopen(f"http://{row.address}:{row.port}/metrics", timeout=5) as answer:
        families = text_string_to_metric_families(answer.read().decode())
        return {
            "_".join((sample.name, *sample.labels.values())): sample.value
            for family in families
            for sample in family.samples
        }


def _press(ros: Ros, crowds: list[subprocess.Popen[str]]) -> tuple[float, float]:
    """The software stop: ms until the last machine has heard it, and until the last goal was asked to end."""
    button = ros.publisher(Bool, "/emergency_signal")
    until(lambda: button.get_subscription_count() > len(crowds), "every machine is known to the button", LIMIT)
    button.publish(Bool())
    assert ros.delivered(button, LIMIT), "not every machine knows the button"
    begun = time.time_ns()
    button.publish(Bool(data=True))
    stamps = []
    for crowd in crowds:
        assert crowd.stdout is not None
        stamps += json.loads(crowd.stdout.readline())
    received, ended = ([(stamp - begun) / 1e6 for stamp in column if stamp] for column in zip(*stamps, strict=True))
    assert len(received) == len(stamps), "a machine has not heard the stop"
    return max(received), max(ended, default=0.0)
