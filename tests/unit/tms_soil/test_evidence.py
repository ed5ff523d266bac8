"""How old what is known of a place is."""

import numpy as np

from tms_soil.evidence import Evidence


def test_the_newest_time_of_a_place() -> None:
    known = Evidence((-10.0, 0.0, 10.0, 5.0))
    known.add([(-10.0, 0.0, -9.0, 1.0), (9.5, 4.5, 30.0, 30.0)], 100.0)
    known.add([(-9.4, 0.0, -9.0, 0.4)], 200.0)
    known.add([(-50.0, -50.0, -40.0, -40.0)], 300.0)
    x, y = np.array([-9.9, -9.1, 0.0, 9.9, 10.5]), np.array([0.9, 0.1, 3.0, 4.9, 4.9])
    assert np.array_equal(known.at(x, y), [100.0, 200.0, np.nan, 100.0, np.nan], equal_nan=True)
