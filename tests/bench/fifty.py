"""Fifty machines in twenty runs, ten of them with all that moves a real one; and twenty consoles, all on one PC.

Each of the ten has a stand-in, a gateway that keeps areas, and subtasks, all processes of their own, and a ground hears
them. The other forty are at the level of messages (rig/crowd.py), as all are in the group `scale`.
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
from bench.scale import A_PROCESS, RUNS, SETTLE, SLOW, after_press, crowd_of, processes, watched
from tms_config.processes import find
from tms_ros.node import Ros
from tms_ur import gateway_areas

REAL = [f"r{number}" for number in range(10)]
CROWD = [f"m{number}" for number in range(40)]
APART = 20.0  # m between two of the ten
SPEED = 0.3  # of a real one: a motion takes about 10 s
ALWAYS = ("tms:store", "tms:db", "tms:ts", "tms:ground", "tms:ur")
BOX = [(-50, -50), (250, -50), (250, 50), (-50, 50), (-50, -50)]  # m


def measure() -> Iterable[Figure]:
    machines = {name: {"model": "zx200", "start": [APART * i, 0.0, 0.0]} for i, name in enumerate(REAL)}
    machines |= {name: {"model": "zx200"} for name in CROWD}
    services: dict[str, object] = {"db": {}, "ts": {}, "ur": {}}
    ground = {"area": [-20.0, -20.0, 200.0, 20.0]}
    with rig(machines=machines, services=services, ground=ground, sim={"speed": SPEED}) as own, ExitStack() as stack:
        _write_area(own)
        scheduler = stack.enter_context(processes(own, dict(os.environ), *ALWAYS, *_parts()))[ALWAYS.index("tms:ts")]
        crowds = [
            stack.enter_context(crowd_of(own, CROWD[i], ",".join(SUBTASKS), *CROWD[i : i + A_PROCESS]))
            for i in range(0, len(CROWD), A_PROCESS)
        ]
        for crowd in crowds:
            assert crowd.stdout is not None
            assert crowd.stdout.readline() == "ready\n"
        yield from _figures(own, stack.enter_context(own.node()), scheduler, crowds)


def _parts() -> list[str]:
    """The processes of the ten."""
    return [part for name in REAL for part in (f"sim:{name}", f"{name}:rc", *(f"{name}:{one}" for one in SUBTASKS))]


def _figures(own: Rig, ros: Ros, scheduler: int, crowds: list[subprocess.Popen[str]]) -> Iterator[Figure]:
    receipts = _heard(ros)
    dispatcher.store_records(ros, [*REAL, *CROWD])
    _enable(own, ros)
    _arm(ros)
    calls = dispatcher.start_all(ros, own.site, RUNS)
    with _consoles(own):
        time.sleep(SETTLE)
        ((late, handed_over, slow, cpu),) = watched({find(own.site, "tms:ts"): scheduler})
        received, _ = after_press(dispatcher.press(ros, len(crowds) + len(REAL)), crowds)
        left = dispatcher.left(calls)
    until(lambda: receipts.keys() == set(REAL), "the receipts of the ten")
    wrong = sum(not one.confirmed for one in receipts.values())
    yield Figure("late ticks", "%", late, 1.0, note=f"hand-over {handed_over:.1f} ms")
    yield Figure(f"hand-overs over {1000 * SLOW:.0f} ms", "%", slow, 1.0)
    yield Figure("processor time of tms:ts", "% core", cpu, 80.0)
    yield Figure("stop heard by the last of forty", "ms", received, 50.0)
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
    """The last receipt of each of the ten, as they come."""
    found: dict[str, StopReceipt] = {}
    for name in REAL:
        ros.subscribe(StopReceipt, f"/{name}/rc/receipts", lambda one: found.__setitem__(one.machine, one), depth=20)
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
