"""Thirty machines in twenty runs, ten of them with real gateways, areas and ground; and twenty consoles, all on one PC.

Each of the ten has a gateway that keeps areas and proves stops, and a ground hears them; the machines themselves and
their subtasks are in rig/driven.py. The others are at the level of messages (rig/crowd.py), as all are in the group
`scale`. With forty of those the two cores of a small PC are full, and processes that stand still stop their machines.
"""

from __future__ import annotations

import json
import os
import subprocess
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager

from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import Rearm

from bench.console import CONSOLES, look
from bench.rig import dispatcher
from bench.rig.dispatcher import END_LIMIT, LIMIT, SUBTASKS, until
from bench.rig.mesh import Rig, rig
from bench.runner import Figure
from bench.scale import A_PROCESS, DRIVEN, RUNS, SETTLE, SLOW, after_press, crowd_of, processes, watched
from tms_cli.drill.record import time_of
from tms_config.processes import find
from tms_ros.node import Ros
from tms_ur import gateway_areas

REAL = [f"r{number}" for number in range(10)]
CROWD = [f"m{number}" for number in range(20)]
ALWAYS = ("tms:store", "tms:db", "tms:ts", "tms:ground", "tms:ur")
GATEWAYS = [f"{name}:rc" for name in REAL]
AT_ONCE = 5  # runs; each takes 3 s to look for subtasks to start, as no host agent is there
DRIVEN_TOGETHER = 5  # machines in one process of rig/driven.py
BOX = [(-50, -50), (250, -50), (250, 50), (-50, 50), (-50, -50)]  # m


def measure() -> Iterable[Figure]:
    machines = {name: {"model": "zx200"} for name in (*REAL, *CROWD)}
    services: dict[str, object] = {"db": {}, "ts": {}, "ur": {}}
    ground = {"area": [-20.0, -20.0, 200.0, 20.0]}
    with rig(machines=machines, services=services, ground=ground) as own, ExitStack() as stack:
        _write_area(own)
        scheduler = stack.enter_context(processes(own, dict(os.environ), *ALWAYS, *GATEWAYS))[ALWAYS.index("tms:ts")]
        crowds = [
            stack.enter_context(crowd_of(own, CROWD[i], ",".join(SUBTASKS), *CROWD[i : i + A_PROCESS]))
            for i in range(0, len(CROWD), A_PROCESS)
        ]
        driven = [
            stack.enter_context(crowd_of(own, REAL[i], ",".join(SUBTASKS), *REAL[i : i + DRIVEN_TOGETHER], kind=DRIVEN))
            for i in range(0, len(REAL), DRIVEN_TOGETHER)
        ]
        for one in (*crowds, *driven):
            assert one.stdout is not None
            assert one.stdout.readline() == "ready\n"
        yield from _figures(own, stack.enter_context(own.node()), scheduler, crowds)


def _figures(own: Rig, ros: Ros, scheduler: int, crowds: list[subprocess.Popen[str]]) -> Iterator[Figure]:
    receipts = _heard(ros)
    dispatcher.store_records(ros, [*REAL, *CROWD])
    _enable(own, ros)
    _arm(ros)
    calls = dispatcher.start_all(ros, own.site, RUNS, AT_ONCE)
    receipts.clear()
    with _consoles(own):
        time.sleep(SETTLE)
        ((late, handed_over, slow, cpu),) = watched({find(own.site, "tms:ts"): scheduler})
        pressed = dispatcher.press(ros, len(crowds) + len(REAL))
        after_press(pressed, crowds)
        left = dispatcher.left(calls)
    until(lambda: receipts.keys() == set(REAL), "the receipts of the ten")
    wrong = sum(not one.confirmed for one in receipts.values())
    begun = max(time_of(one.stamp) for one in receipts.values())
    yield Figure("late ticks", "%", late, 1.0, note=f"hand-over {handed_over:.1f} ms")
    yield Figure(f"hand-overs over {1000 * SLOW:.0f} ms", "%", slow, 1.0)
    yield Figure("processor time of tms:ts", "% core", cpu, 80.0)
    yield Figure("stop begun by the last of ten", "ms", 1000 * begun - pressed / 1e6, 50.0)
    yield Figure(f"runs left after {END_LIMIT:.0f} s", "", float(left), 0.5)
    yield Figure("of ten, not proven to stand", "", float(wrong), 0.5)


def _write_area(own: Rig) -> None:
    folder = own.mesh.site.with_suffix("") / "areas"
    folder.mkdir(parents=True)
    shape = {"type": "Polygon", "coordinates": [BOX]}
    feature = {"type": "Feature", "properties": {"id": "yard", "type": "unmanned"}, "geometry": shape}
    (folder / "yard.geojson").write_text(
        json.dumps({"type": "FeatureCollection", "frame": "map", "features": [feature]})
    )


def _enable(own: Rig, ros: Ros) -> None:
    """The areas of the ten; the others' gateways are none."""
    from tms_areas.geojson import gathered, read
    from tms_reason.errors import TmsError

    text = (own.mesh.site.with_suffix("") / "areas/yard.geojson").read_text(encoding="utf-8")
    areas = gathered([read(text, "yard.geojson", None)])

    def enabled() -> bool:
        try:
            gateway_areas.enable(ros, REAL, areas, "a person")
        except TmsError:  # one of them is not there yet
            return False
        return True

    until(enabled, "the ten keep the areas")


def _arm(ros: Ros) -> None:
    from tms_reason.errors import RosError

    def armed(name: str) -> bool:
        try:
            first = ros.call(Rearm, f"/{name}/rearm", Rearm.Request(), LIMIT)
            done = ros.call(Rearm, f"/{name}/rearm", Rearm.Request(token=first.token), LIMIT) if first.token else first
        except RosError:  # a service drops its answer to a client that it has not found yet
            return False
        return done.error_code in ("", "NOT_STOPPED")

    for name in REAL:
        until(lambda name=name: armed(name), f"{name} is armed")  # type: ignore[misc]


def _heard(ros: Ros) -> dict[str, StopReceipt]:
    """The first receipt of each of the ten, as they come; a run that ends stops its machines once more."""
    found: dict[str, StopReceipt] = {}
    for name in REAL:
        ros.subscribe(StopReceipt, f"/{name}/rc/receipts", lambda one: found.setdefault(one.machine, one), depth=20)
    return found


@contextmanager
def _consoles(own: Rig) -> Iterator[None]:
    """Twenty, that hear everything."""
    leave, port = threading.Event(), own.site.file.ports.console
    threads = [threading.Thread(target=look, args=(port, leave), daemon=True) for _ in range(CONSOLES)]
    for thread in threads:
        thread.start()
    yield
    leave.set()
    for thread in threads:
        thread.join(LIMIT)
