"""Ten runs at once in one scheduler: whether each still gets its ticks.

The runs' nodes change twice a second. Counted by tms:ts itself: its ticks, and those that took longer than their
period. The floor is one run alone, in the same mesh.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterable
from pathlib import Path

from bench.rig.costs import counted
from bench.rig.mesh import Rig, rig, until
from bench.runner import Figure
from tms_config.processes import find

RUNS, SECONDS = 10, 10.0
PERIOD = 50.0  # ms between the ticks of a run
TREE = """<root main_tree_to_execute="M"><BehaviorTree ID="M"><KeepRunningUntilFailure><Sequence name="run {number}">
<Delay delay_msec="500"><AlwaysSuccess name="a"/></Delay><Delay delay_msec="500"><AlwaysSuccess name="b"/></Delay>
</Sequence></KeepRunningUntilFailure></BehaviorTree></root>"""


def measure() -> Iterable[Figure]:
    with rig(services={"db": {}, "ts": {}, "host": {}}, machines={}) as own:
        own.mesh.tms("up")
        tasks = [_stored(own, number) for number in range(RUNS)]
        started = [_started(own, tasks[0])]
        alone, _ = _ticks(own, 1)
        started += [_started(own, task) for task in tasks[1:]]
        period, overruns = _ticks(own, RUNS)
        assert set(started) == _running(own), "a run has ended"
    yield Figure("tick period, 10", "ms", period, 1.05 * PERIOD, alone, usual_floor=PERIOD)
    yield Figure("late ticks, 10", "%", 100 * overruns, 1.0)


def _stored(own: Rig, number: int) -> str:
    file = Path(own.mesh.state) / f"run_{number}.xml"
    file.write_text(TREE.format(number=number))
    return str(json.loads(own.mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])


def _started(own: Rig, task: str) -> str:
    run = str(json.loads(own.mesh.tms("run", task, "--json").stdout)["run_id"])
    until(lambda: run in _running(own), f"run {run}")
    return run


def _running(own: Rig) -> set[str]:
    rows = json.loads(own.mesh.tms("runs", "--json").stdout)
    return {row["run_id"] for row in rows if row["state"] == "running"}


def _ticks(own: Rig, runs: int) -> tuple[float, float]:
    """Milliseconds between the ticks of a run, and the part of them that took longer than that."""
    (count, late), begun = _counted(own), time.monotonic()
    time.sleep(SECONDS)
    (count_after, late_after), took = _counted(own), time.monotonic() - begun
    ticks = count_after - count
    return runs * took * 1000 / ticks, (late_after - late) / ticks


def _counted(own: Rig) -> tuple[float, float]:
    found = counted(find(own.site, "tms:ts"))
    return found["tms_ts_tick_seconds_count"], found["tms_ts_tick_overruns_total"]
