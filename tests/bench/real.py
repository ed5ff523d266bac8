"""Thirty machines in twenty runs, ten of them with real gateways, areas and ground; and twenty consoles, all on one PC.

Each of the ten has a gateway that keeps areas and proves stops, and a ground hears them; the machines themselves and
their subtasks are in rig/driven.py. The others are at the level of messages (rig/crowd.py), as all are in the group
`scale`. With forty of those the two cores of a small PC are full, and processes that stand still stop their machines.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack

from tms_msg_rc.msg import StopReceipt

import area_file
from bench.console import consoles
from bench.rig import dispatcher
from bench.rig.dispatcher import END_LIMIT, until
from bench.rig.mesh import Rig, rig
from bench.runner import Figure
from bench.scale import DRIVEN, RUNS, SETTLE, SLOW, after_press, machines_of, processes, watched
from bench.yard.machines import ARMED, why_not_armed
from tms_cli import area_sets
from tms_cli.drill.record import time_of
from tms_config.processes import find
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ur import gateway_areas

REAL = [f"r{number}" for number in range(10)]
CROWD = [f"m{number}" for number in range(20)]
ALWAYS = ("tms:store", "tms:db", "tms:ts", "tms:ground", "tms:ur")
GATEWAYS = [f"{name}:rc" for name in REAL]
AT_ONCE = 2  # runs; each takes 3 s to look for subtasks to start, as no host agent is there
DRIVEN_TOGETHER = 5  # machines in one process of rig/driven.py
AREAS = {"yard": ("unmanned", [(-50, -50), (250, -50), (250, 50), (-50, 50)])}


def measure() -> Iterable[Figure]:
    machines = {name: {"model": "zx200"} for name in (*REAL, *CROWD)}
    services: dict[str, object] = {"db": {}, "ts": {}, "ur": {}}
    ground = {"area": [-20.0, -20.0, 200.0, 20.0]}
    with rig(machines=machines, services=services, ground=ground) as own, ExitStack() as stack:
        area_file.write(own.mesh, AREAS)
        scheduler = stack.enter_context(processes(own, dict(os.environ), *ALWAYS, *GATEWAYS))[ALWAYS.index("tms:ts")]
        crowds = stack.enter_context(machines_of(own, CROWD))
        stack.enter_context(machines_of(own, REAL, DRIVEN, DRIVEN_TOGETHER))
        yield from _figures(own, stack.enter_context(own.node()), scheduler, crowds)


def _figures(own: Rig, ros: Ros, scheduler: int, crowds: list[subprocess.Popen[str]]) -> Iterator[Figure]:
    receipts = _heard(ros)
    dispatcher.store_records(ros, [*REAL, *CROWD])
    _enable(own, ros)
    for name in REAL:
        until(lambda name=name: why_not_armed(ros, name) in ARMED, f"{name} is armed")  # type: ignore[misc]
    calls = dispatcher.start_all(ros, own.site, RUNS, AT_ONCE)
    receipts.clear()
    with consoles(own.site.file.ports.console):
        time.sleep(SETTLE)
        ((late, handed_over, slow, cpu),) = watched({find(own.site, "tms:ts"): scheduler})
        early, why = len(receipts), sorted({f"{one.cause} {one.detail}" for one in receipts.values()})
        receipts.clear()
        pressed = dispatcher.press(ros, len(crowds) + len(REAL))
        after_press(pressed, crowds)
        left = dispatcher.left(calls)
    until(lambda: receipts.keys() == set(REAL), "the receipts of the ten")
    wrong = sum(not one.confirmed for one in receipts.values())
    begun = max(time_of(one.stamp) for one in receipts.values())
    yield Figure("late ticks", "%", late, 1.0, note=f"hand-over {handed_over:.1f} ms")
    yield Figure(f"hand-overs over {1000 * SLOW:.0f} ms", "%", slow, 1.0)
    yield Figure("processor time of tms:ts", "% core", cpu, 80.0)
    yield Figure("of ten, stopped before the press", "", float(early), 0.5, note="; ".join(why))
    yield Figure("stop begun by the last of ten", "ms", 1000 * begun - pressed / 1e6, 50.0)
    yield Figure(f"runs left after {END_LIMIT:.0f} s", "", float(left), 0.5)
    yield Figure("of ten, not proven to stand", "", float(wrong), 0.5)


def _enable(own: Rig, ros: Ros) -> None:
    """The areas of the ten; the others' gateways are none."""
    areas = area_sets.configured(own.site)

    def enabled() -> bool:
        try:
            gateway_areas.enable(ros, REAL, areas, "a person")
        except TmsError:  # one of them is not there yet
            return False
        return True

    until(enabled, "the ten keep the areas")


def _heard(ros: Ros) -> dict[str, StopReceipt]:
    """The first receipt of each of the ten, as they come; a run that ends stops its machines once more."""
    found: dict[str, StopReceipt] = {}
    for name in REAL:
        ros.subscribe(StopReceipt, f"/{name}/rc/receipts", lambda one: found.setdefault(one.machine, one), depth=20)
    return found
