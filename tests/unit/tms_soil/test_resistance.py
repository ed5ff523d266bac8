"""The fundamental earthmoving equation, against vectors that were computed by hand from the published formulas."""

import math

import numpy as np
import pytest

from earth_rig import FORCES, PLACES, VECTORS, WIDTH, soil_of_vector, soils
from tms_soil.resistance import factors, force, speed_share


@pytest.mark.parametrize("name", VECTORS)
def test_published_formulas(name: str) -> None:
    *_, plane, weight, stuck = VECTORS[name]
    soil = soil_of_vector(name)
    found = factors(soil, math.radians(45))
    assert math.degrees(found.plane) == pytest.approx(plane, rel=0.02)
    assert (found.weight, found.cohesion) == pytest.approx((weight, stuck), rel=0.02)
    for (rake, depth), wanted in zip(PLACES, FORCES[name], strict=True):
        # The forces are given to 0.1 kN.
        found_force = force(soil, math.radians(rake), WIDTH, np.array([depth])) / 1e3
        assert found_force == pytest.approx(wanted, rel=0.02, abs=0.05)


def test_a_load_on_the_ground_and_a_deeper_part_of_the_edge_count() -> None:
    earth = soils()[0]
    even, uneven = (force(earth, 0.8, 1.0, np.array(depths)) for depths in ([0.2, 0.2], [0.0, 0.4]))
    assert uneven > even
    factor = factors(earth, 0.8).surcharge
    assert force(earth, 0.8, 1.0, np.array([0.2]), 1000.0) - even == pytest.approx(1000 * factor * 0.2)


def test_what_resists_more_than_the_tool_can_is_a_stall() -> None:
    assert [speed_share(part, 100.0) for part in (0.0, 25.0, 100.0, 300.0)] == [1.0, 0.75, 0.0, 0.0]
