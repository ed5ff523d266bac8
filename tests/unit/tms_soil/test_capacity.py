"""What buckets keep, against volumes that were measured in the meshes of OPERA's machines."""

import itertools
import math

import numpy as np
import pytest

from earth_rig import model_of
from tms_soil.capacity import Capacity, tilt_of

# model: struck, heaped 1:2, heaped 1:1 [m3]
MEASURED = {"zx200": (0.68, 0.84, 0.96), "zx120": (0.295, 0.36, 0.40)}
LEVEL = math.radians(217)  # pitch of the zx200's bucket with its opening upwards


@pytest.mark.parametrize("name", MEASURED)
def test_volumes_of_the_meshes(name: str) -> None:
    bucket = model_of(name).bucket
    assert bucket is not None
    found = [Capacity(bucket, slope).heaped for slope in (1e-6, 0.5, 1.0)]
    assert found == pytest.approx(MEASURED[name], rel=0.06)


def test_a_bucket_empties_as_it_opens() -> None:
    bucket = model_of("zx200").bucket
    assert bucket is not None
    capacity = Capacity(bucket, 0.7)
    assert capacity.at(LEVEL) == pytest.approx(capacity.heaped, rel=0.02)
    tilted = [capacity.at(LEVEL - math.radians(angle)) for angle in range(0, 180, 15)]
    assert all(more >= less for more, less in itertools.pairwise(tilted))
    assert tilted[8] < 0.02 * capacity.heaped, "120 deg from level nothing but a rest stays"
    assert capacity.at(LEVEL + math.pi) == 0.0, "upside down"


@pytest.mark.parametrize("tilt", [-2.0, 0.3, 1.5])
def test_tilt_is_the_pitch_of_the_link(tilt: float) -> None:
    c, s = math.cos(tilt), math.sin(tilt)
    assert tilt_of(np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])) == pytest.approx(tilt)
