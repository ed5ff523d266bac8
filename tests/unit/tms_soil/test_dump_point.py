"""Where a bucket opens: over the vessel, each part in turn, from its load alone; and when the vessel is full."""

import math

import numpy as np
import pytest

from earth_rig import model_of
from tms_config.models import Vessel
from tms_control.links import Links, Matrix, placed
from tms_soil.dig_point import Stand
from tms_soil.dump_point import FALLS, FULL, dump_point, full

IC120 = model_of("ic120")
BUCKET = 0.65  # m3, loose
WIDTH = 1.05  # m
EDGE = 1.93  # m, of its sides in the vessel's link


def vessel() -> Vessel:
    assert IC120.vessel is not None
    return IC120.vessel


def lowered(base: Matrix) -> Matrix:
    """The vessel's link in map."""
    link = vessel().link
    return base @ Links(IC120, [link]).places(np.zeros((1, 1)))[link][0]


def falls(stand: Stand, base: Matrix, load: float) -> tuple[float, float]:
    """Where soil comes down: along and across the vessel [m, its link]."""
    place = lowered(base)
    at = dump_point(vessel(), place, EDGE, load, WIDTH, BUCKET, stand)
    out, bearing = math.hypot(at.x, at.y) + FALLS, math.atan2(at.y, at.x) + stand.yaw
    in_map = np.array([stand.x + out * math.cos(bearing), stand.y + out * math.sin(bearing), 0.0, 1.0])
    seen = np.linalg.inv(place) @ in_map
    return float(seen[0]), float(seen[1])


@pytest.mark.parametrize("stand", [Stand(0.0, 0.0, 0.0, 0.0), Stand(10.0, -3.0, 1.0, 2.0)])
@pytest.mark.parametrize("yaw", [0.0, 1.57, -2.0])
def test_buckets_lie_along_the_vessel_in_turn(stand: Stand, yaw: float) -> None:
    base = placed(stand.x + 6.0, stand.y + 1.0, yaw)
    found = [falls(stand, base, number * BUCKET) for number in range(6)]
    least, most = vessel().min, vessel().max
    assert all(across == pytest.approx((least[1] + most[1]) / 2, abs=1e-6) for _, across in found)
    along = [place for place, _ in found]
    parts = sorted({round(place, 6) for place in along})
    assert len(parts) >= 2 and least[0] < parts[0] and parts[-1] < most[0]
    assert sum(parts) / len(parts) == pytest.approx((least[0] + most[0]) / 2), "evenly"
    assert along[: len(parts)] == pytest.approx(parts[::-1]), "from its front"
    assert along == pytest.approx([along[k % len(parts)] for k in range(6)]), "and again"


def test_a_load_that_is_a_little_off_changes_nothing() -> None:
    stand, base = Stand(0.0, 0.0, 0.0, 0.0), placed(6.0, 0.0, 1.57)
    exact = falls(stand, base, BUCKET)
    for load in (0.8 * BUCKET, 1.2 * BUCKET):
        assert falls(stand, base, load) == exact


def test_it_is_above_the_edge() -> None:
    at = dump_point(vessel(), lowered(placed(6.0, 0.0, 0.0)), EDGE, 0.0, WIDTH, BUCKET, Stand(0.0, 0.0, 0.0, 0.0))
    assert at.z == pytest.approx(4.5, abs=0.1)
    low = dump_point(vessel(), lowered(placed(6.0, 0.0, 0.0)), EDGE, 0.0, WIDTH, BUCKET, Stand(0.0, 0.0, -1.0, 0.0))
    assert low.z == pytest.approx(at.z + 1.0)


def test_full() -> None:
    assert not full(vessel(), 0.0)
    assert not full(vessel(), (FULL - 0.01) * vessel().heaped)
    assert full(vessel(), (FULL + 0.01) * vessel().heaped)
