"""The fundamental earthmoving equation, against vectors that were computed by hand from the published formulas."""

import math

import numpy as np
import pytest

from earth_rig import soils
from tms_soil.resistance import factors, force, speed_share

WIDTH = 1.05  # m
# density kg/m3, cohesion Pa, friction deg, steel deg: failure plane deg, factors of weight and cohesion, kN at 0.2, 0.3
# and 0.4 m
VECTORS = {
    "earth of OperaSim-AGX": (1474, 2100, 40, 24, 29.3, 1.96, 2.35, (2.2, 4.2, 6.8)),
    "dry sand": (1500, 0, 34, 22, 31.9, 1.62, 2.14, (1.0, 2.3, 4.0)),
    "sandy loam": (1600, 5000, 30, 20, 33.8, 1.44, 2.00, (3.0, 5.3, 8.0)),
    "stiff clay": (1900, 40000, 15, 10, 42.3, 0.95, 1.55, (13.8, 21.2, 29.0)),
}
STEEPER = dict(zip(VECTORS, (5.6, 2.6, 6.6, 25.0), strict=True))  # kN at 0.3 m, rake of 60 deg


@pytest.mark.parametrize("name", VECTORS)
def test_published_formulas(name: str) -> None:
    bank, cohesion, friction, steel, plane, weight, stuck, forces = VECTORS[name]
    soil = soils()[0].model_copy(
        update={"bank": bank, "cohesion": cohesion, "friction": friction, "steel": steel},
    )
    found = factors(soil, math.radians(45))
    assert math.degrees(found.plane) == pytest.approx(plane, rel=0.02)
    assert (found.weight, found.cohesion) == pytest.approx((weight, stuck), rel=0.02)
    for depth, wanted in zip((0.2, 0.3, 0.4), forces, strict=True):
        # The forces are given to 0.1 kN.
        assert force(soil, math.radians(45), WIDTH, np.array([depth])) / 1e3 == pytest.approx(
            wanted, rel=0.02, abs=0.05
        )
    assert force(soil, math.radians(60), WIDTH, np.array([0.3])) / 1e3 == pytest.approx(
        STEEPER[name], rel=0.02, abs=0.05
    )


def test_a_load_on_the_ground_and_a_deeper_part_of_the_edge_count() -> None:
    earth = soils()[0]
    even, uneven = (force(earth, 0.8, 1.0, np.array(depths)) for depths in ([0.2, 0.2], [0.0, 0.4]))
    assert uneven > even
    factor = factors(earth, 0.8).surcharge
    assert force(earth, 0.8, 1.0, np.array([0.2]), 1000.0) - even == pytest.approx(1000 * factor * 0.2)


def test_what_resists_more_than_the_tool_can_is_a_stall() -> None:
    assert [speed_share(part, 100.0) for part in (0.0, 25.0, 100.0, 300.0)] == [1.0, 0.75, 0.0, 0.0]
