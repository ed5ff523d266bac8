"""Ways of a motion controller stay in the enabled areas, where the straight one would leave them."""

import json
import math
from types import SimpleNamespace
from typing import Any

import shapely
import shapely.affinity
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import GetParameters

from tms_areas.areas import Area, AreaSet
from tms_areas.body import Silhouette
from tms_areas.braking import tracks_of
from tms_areas.fix import Motion, Seen
from tms_areas.geojson import written
from tms_areas.guard import Guard
from tms_areas.law import Law
from tms_areas.walls import THICK, walls
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.detour import Question
from tms_control.ground import Ground, Outline
from tms_control.path import Pose
from tms_control.planner import Goal, Pace, Plan
from tms_mc.area_walls import AreaWalls

TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
BENT = AreaSet((
    Area("bent", "unmanned", ((0, 0), (40, 0), (40, 40), (26, 40), (26, 14), (0, 14))),
    Area("hut", "manned", ((12, 0), (14, 0), (14, 3), (12, 3))),
))  # fmt: skip
START, GOAL = Pose(7.0, 8.0, 0.0), Pose(33.0, 33.0, math.pi / 2)


class Gateway:
    """Answers what is enabled."""

    def __init__(self, areas: AreaSet | None) -> None:
        self.areas, self.asked = areas, 0

    def call(self, _: Any, service: str, request: GetParameters.Request, limit: float) -> GetParameters.Response:
        assert service == "/ic120/rc/areas/get" and request.names == ["id", "areas"]
        self.asked += 1
        told = ("", "") if self.areas is None else (self.areas.id, json.dumps(written(self.areas)))
        return GetParameters.Response(values=[ParameterValue(string_value=one) for one in told])


def made(gateway: Gateway, has_areas: bool = True) -> AreaWalls:
    site = SimpleNamespace(area_files=["yard.geojson"] if has_areas else [], model_of=lambda _: TRUCK)
    return AreaWalls(SimpleNamespace(ros=gateway, site=site, machine="ic120"))  # type: ignore[arg-type]


def way(ground: Ground) -> Plan:
    found = Question(START, (Goal(*GOAL),), Pace(forward=1.0, turn=0.24), 0.0, Outline.of(TRUCK), ground).answer()
    assert isinstance(found, Plan), found
    return found


def leaves(found: Plan) -> bool:
    """Whether the machine is outside somewhere on a way, by the geometry library."""
    outline, usable = shapely.Polygon(Outline.of(TRUCK).polygon), BENT.usable()
    for x, y, yaw in found.path.poses(0.1):
        turned = shapely.affinity.rotate(outline, yaw, origin=(0, 0), use_radians=True)
        if not usable.contains(shapely.affinity.translate(turned, x, y)):
            return True
    return False


def test_a_way_stays_inside_where_the_straight_one_leaves() -> None:
    assert leaves(way(Ground()))
    found = way(Ground(tuple(made(Gateway(BENT)).read(START))))
    assert not leaves(found)
    law = Law(BENT, "ic120", tracks_of(TRUCK, TRUCK.borders["opera"]))
    guard, joints = Guard(law, Silhouette(TRUCK)), {"vessel_pin_joint": 0.0}
    for x, y, yaw in found.path.poses(0.5):  # the gateway does not stop it there
        motion = Motion(x, y, yaw, 0.5 * math.cos(yaw), 0.5 * math.sin(yaw))
        assert guard.look(Seen(None, motion), joints, tracks=True).stop is None, (x, y, yaw)


def test_a_wall_lies_along_each_border_and_outside() -> None:
    found = [shapely.Polygon(one) for one in walls(BENT)]
    assert all(one.is_valid for one in found) and shapely.union_all(found).intersection(BENT.usable()).area < 1e-6
    ring = BENT.usable().buffer(0.9 * THICK, join_style="bevel").difference(BENT.usable())
    assert ring.difference(shapely.union_all(found).buffer(1e-6)).area < 0.2 * ring.area
    assert shapely.union_all(found).buffer(1e-6).contains(BENT.usable().boundary)


def test_walls_in_which_it_stands_do_not_keep_it() -> None:
    walls_of = made(Gateway(BENT))
    every, fewer = walls_of.read(START), walls_of.read(Pose(0.5, 8.0, 0.0))
    assert 0 < len(fewer) < len(every)


def test_the_areas_are_read_anew_when_others_are_enabled() -> None:
    gateway = Gateway(None)
    walls_of = made(gateway)
    assert walls_of.read(START) == []
    gateway.areas = BENT
    first = walls_of.read(START)
    assert len(first) > 5 and walls_of.read(START)[0] is first[0]
    gateway.areas = None
    assert walls_of.read(START) == []


def test_a_site_without_areas_asks_nobody() -> None:
    gateway = Gateway(BENT)
    assert made(gateway, has_areas=False).read(START) == [] and gateway.asked == 0


def test_what_is_closed_inside_has_walls_too() -> None:
    assert shapely.union_all([shapely.Polygon(one) for one in walls(BENT)]).intersects(shapely.Point(13.0, 1.5))
