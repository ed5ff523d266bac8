"""Where to dig next: most soil for the time, never below the design, outside of others; or nothing is left."""

import math
from dataclasses import replace

import numpy as np
import pytest

from earth_rig import NAMES, START, flat, model_of, reports, soils
from tms_control.links import placed
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.digging import excavate
from tms_rp.kinds.backhoe.goals import Dig, TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.scene import Scene
from tms_rp.ways import Ways
from tms_soil.dig_point import Digging, DigPoint, Stand, dig_points
from tms_soil.earth import Earth
from tms_soil.grid import Grid
from tms_soil.surface import Heights, Point

ZX200 = model_of("zx200")
HERE = Stand(0.0, 0.0, 0.0, 0.0)
RIGHT = [(-4.0, -9.5), (4.0, -9.5), (4.0, -3.5), (-4.0, -3.5)]  # m, beside the machine
FRONT = 0.0  # rad, where its truck stands
LEVEL = flat(25.6)


def tool() -> Digging:
    assert ZX200.bucket is not None
    return Digging.of(ZX200.bucket, holds=0.83, near=4.8, far=8.4, deepest=1.8)


def design(level: float, ground: Heights = LEVEL) -> Heights:
    return replace(ground, z=np.full(ground.z.shape, level))


def points(
    ground: Heights, floor: float = -1.5, stand: Stand = HERE, allowed: list[Point] = RIGHT,
    taken: list[list[Point]] | None = None,
) -> list[DigPoint]:  # fmt: skip
    return dig_points(ground, design(floor, ground), stand, tool(), allowed, taken or [], FRONT)


def bearing(point: DigPoint) -> float:
    return math.atan2(point.y, point.x)


def test_it_fills_a_bucket_where_the_turn_is_short() -> None:
    best, *others = points(LEVEL)
    assert 0.55 <= best.loose <= 0.9
    assert all(one.benefit <= best.benefit for one in others)
    assert abs(bearing(best)) == min(abs(bearing(one)) for one in (best, *others))
    assert tool().near <= math.hypot(best.x, best.y) <= tool().far


def test_it_digs_where_most_lies() -> None:
    x, y = LEVEL.centres
    heap = replace(LEVEL, z=np.where(np.hypot(x + 2.0, y + 6.0) < 1.0, 1.0, 0.0))
    best = points(heap, floor=0.0)[0]
    assert math.hypot(best.x + 2.0, best.y + 6.0) < 2.0
    assert best.z - best.depth >= -1e-9, "the heap alone"


@pytest.mark.parametrize("floor", [-0.2, -0.6, -1.5])
def test_it_stays_above_the_design(floor: float) -> None:
    found = points(LEVEL, floor)
    assert found and all(one.z - one.depth >= floor - 1e-9 for one in found)
    assert max(one.depth for one in found) == pytest.approx(min(1.1, -floor)), "down to it, as far as it digs at once"


def test_nothing_is_left_where_the_design_is_reached() -> None:
    assert points(design(-1.5)) == []
    assert points(design(-1.45)) == [], "a few centimetres fill no bucket"
    assert points(LEVEL, math.nan) == [], "no design, nothing to dig"
    assert points(LEVEL, allowed=[(9.0, 9.0), (12.0, 9.0), (12.0, 12.0)]) == [], "out of reach"
    unknown = replace(LEVEL, z=np.full(LEVEL.z.shape, np.nan))
    assert points(unknown) == [], "nobody knows the ground"


def test_it_keeps_off_other_machines() -> None:
    best = points(LEVEL)[0]
    truck = [(best.x - 1, best.y - 1), (best.x + 1, best.y - 1), (best.x + 1, best.y + 1), (best.x - 1, best.y + 1)]
    found = points(LEVEL, taken=[truck])
    assert found
    for one in found:
        end = 1 - one.drag / math.hypot(one.x, one.y)
        for share in (1.0, end):
            away = max(abs(one.x * share - best.x), abs(one.y * share - best.y)) - 1
            assert away >= tool().width / 2 - 1e-9


def test_it_is_told_from_the_machine_wherever_that_stands() -> None:
    x, y = LEVEL.centres
    (here, *_) = points(replace(LEVEL, z=0.1 * x))
    place, height = placed(3.0, -2.0, 0.7), 5.0
    wide = flat(40.0)
    x, y = wide.centres
    along = (x - 3.0) * place[0, 0] + (y + 2.0) * place[1, 0]  # x of the machine
    area = [(float(at[0]), float(at[1])) for at in (place @ (*one, 0.0, 1.0) for one in RIGHT)]
    (there, *_) = points(replace(wide, z=0.1 * along + height), -1.5 + height, Stand(3.0, -2.0, height, 0.7), area)
    assert (there.x, there.y, there.z) == pytest.approx((here.x, here.y, here.z), abs=1e-6)


def test_bucket_after_bucket_brings_what_was_told() -> None:
    """Planned by the planner and dug in the ground of tms_soil: 0.5 to 0.9 m3 each."""
    backhoe, ways = Backhoe(ZX200), Ways(ZX200, load("backhoe"))
    earth = Earth(Grid.from_heights(flat(25.6), soils()), {"zx200": ZX200})
    digger, time = earth.bodies["zx200"].digger, 0.0
    assert digger is not None
    for _ in range(5):
        best = points(earth.grid.heights())[0]
        goal = Dig(TipGoal(best.x, best.y, best.z, 0.9), best.depth, best.drag, lift=0.5)
        made = ways.plan(START, excavate(backhoe, ArmAngles(*START), goal), Scene()).made
        for sample in made.samples:
            angles = dict(zip(made.names, sample.positions, strict=True))
            earth.report("zx200", time + sample.time, angles, np.eye(4))
        assert 0.5 <= digger.volume <= 0.9
        assert 0.65 <= best.loose / digger.volume <= 1.2, "what was told is no less careful than true"
        time += made.duration + 1.0
        digger.load[:] = 0.0
        for report in reports([(time + 10.0, START)]):
            earth.report(*report)
    assert set(NAMES) < set(made.names)


def test_what_is_like_a_place_that_cannot_be_dug_is_near_it_and_as_low() -> None:
    hole = DigPoint(0.0, -6.0, -0.6, 0.5, 1.0, 0.8, 0.04)
    assert replace(hole, y=-6.3, z=-0.5).like(hole)
    assert not replace(hole, y=-6.9).like(hole)
    assert not replace(hole, depth=0.2).like(hole)
    assert not replace(hole, y=-6.3, z=0.0).like(hole)  # the ridge beside it, from its top
