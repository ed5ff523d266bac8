"""Two trucks and a road for one of them: they take turns, never are both on it, and both come to an end.

TMS_ROUNDS: how often each drives over the road. One holds the road by nodes of its tree, the other by its goals alone.
"""

import json
import os
import subprocess
import threading
from collections.abc import Iterator

import pytest
from tms_msg_areas.msg import Place, Places

import area_file
from conftest import NO_CONSOLE, Mesh, mesh_apart, node_in, wait_until
from tms_config.config import load_site
from tms_machine.places import Places as Poses

ROUNDS = int(os.environ.get("TMS_ROUNDS", "5"))
pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(300 + 60 * ROUNDS)]
CROSSING = 40.0  # s that one drive may take at most, with its wait for the other truck
LANES = {"ic120_1": -6.0, "ic120_2": 6.0}  # m, y
ROAD = (10.0, 11.5)  # m, x; as wide as both lanes
ENDS = {"WEST": (3.0, 180), "EAST": (18.5, 0)}  # m, x, and deg
BODY = (-3.6, 2.0)  # m, behind and before its base
SITE = {
    "machines": {name: {"model": "ic120", "start": [3.0, lane, 0.0]} for name, lane in LANES.items()},
    "sim": {"speed": 2.0},  # faster than that no gateway with areas believes a pose
}
AREAS = {
    "yard": ("unmanned", [(-80, -80), (100, -80), (100, 80), (-80, 80)]),
    "road": ("release", [(ROAD[0], -15), (ROAD[1], -15), (ROAD[1], 15), (ROAD[0], 15)]),
}
LEAF = '<Action ID="LeafNodeIc120" model_name="{}" record_name="{}" subtask_name="st_ic120_navigate_anywhere_deg"/>'
HELD = '<HoldPlace place="road" model_name="{0}"/>{1}<FreePlace place="road" model_name="{0}"/>'


def task(machine: str, by_nodes: bool) -> str:
    drives = [LEAF.format(machine, ("EAST", "WEST")[number % 2]) for number in range(ROUNDS)]
    inner = "".join(HELD.format(machine, drive) if by_nodes else drive for drive in drives)
    body = f"<Sequence>{inner}</Sequence>"
    return f'<root main_tree_to_execute="T"><BehaviorTree ID="T">{body}</BehaviorTree></root>'


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mesh]:
    with mesh_apart(tmp_path_factory.mktemp("places"), **NO_CONSOLE, **SITE) as made:
        try:
            area_file.up(made, AREAS)
            for name, lane in LANES.items():
                for end, (x, yaw) in ENDS.items():
                    fields = (f"x={x}", f"y={lane}", "z=0.0", f"yaw={float(yaw)}")
                    made.tms("param", "set", f"{name}/{end}", *fields, "--create")
            yield made
        finally:
            made.tms("down")


class Watch:
    """Who truly is on the road, judged by numbers alone, and who has held it."""

    def __init__(self, node: object) -> None:
        self.both, self.looks, self.road = False, 0, [Place()]
        self.holders: list[str] = []
        site = load_site()
        self._poses = Poses(node, {name: site.border(name) for name in LANES})  # type: ignore[arg-type]
        node.subscribe(Places, "/tms/places", self._heard, latched=True)  # type: ignore[attr-defined]
        node.every(0.04, self._look)  # type: ignore[attr-defined]

    def _heard(self, told: Places) -> None:
        self.road = [one for one in told.places if one.name == "road"]
        if self.road and self.road[0].holder and self.road[0].holder != (self.holders or [""])[-1]:
            self.holders.append(self.road[0].holder)

    def _look(self) -> None:
        self._poses.take()
        poses = [self._poses.place(name) for name in LANES]
        on = [one is not None and self._touches(one.x, one.yaw) for one in poses]
        self.looks += all(one is not None for one in poses)
        self.both = self.both or all(on)

    @staticmethod
    def _touches(x: float, yaw: float) -> bool:
        ends = [x + far * (1.0 if abs(yaw) < 1.57 else -1.0) for far in BODY]
        return max(ends) > ROAD[0] and min(ends) < ROAD[1]


def test_two_trucks_take_turns_on_a_road(mesh: Mesh) -> None:
    numbers = []
    for name in LANES:
        file = mesh.state / f"{name}.xml"
        file.write_text(task(name, by_nodes=name == "ic120_1"))
        numbers.append(str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"]))
    ends: list[subprocess.CompletedProcess[str]] = []
    with node_in(mesh) as node:
        watch = Watch(node)
        wait_until(lambda: watch.looks > 0, 20, "both trucks tell where they are")

        def go(number: str) -> None:
            ends.append(mesh.tms("run", number, "--wait", expect=None, limit=60 + 2 * ROUNDS * CROSSING))

        threads = [threading.Thread(target=go, args=(number,)) for number in numbers]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        assert [one.returncode for one in ends] == [0, 0], "\n".join(one.stdout + one.stderr for one in ends)
        assert not watch.both and watch.looks > 50
        assert set(watch.holders) == set(LANES) and len(watch.holders) > 2, "they took turns"
        wait_until(lambda: bool(watch.road) and watch.road[0].state == Place.FREE, 20, "the road is free again")
    assert json.loads(mesh.tms("places", "--json").stdout)["places"][0]["state"] == "free"


def test_unknown_places_and_places_of_nobody(mesh: Mesh) -> None:
    file = mesh.state / "unknown.xml"
    file.write_text(task("ic120_1", by_nodes=True).replace('place="road"', 'place="rood"'))
    found = mesh.tms("task", "check", str(file), expect=None)
    assert found.returncode != 0 and "rood" in found.stdout + found.stderr
    nobody = mesh.tms("places", "revoke", "road", "--yes", expect=None)
    assert nobody.returncode != 0 and "nobody holds road" in nobody.stderr
