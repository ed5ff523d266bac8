"""Coordinates against values that Japan's survey authority (GSI) publishes, and back."""

import math

import numpy as np
import pytest

from tms_ground.frame import WGS84, SiteFrame, crs
from tms_ground.reasons import FrameUnits, FrameUnknown
from tms_ground.settings import Origin
from tms_reason.errors import TmsError

# Plane, latitude, longitude [deg], X north, Y east [m], as GSI's service "Conversion to plane rectangular coordinates"
# (vldb.gsi.go.jp, bl2xy) tells them; the second one is the example on its page: 36 06 13.58925, 140 05 16.27815.
PUBLISHED = [
    (1, 33.190977, 129.917483, 21256.0449, 38927.1043),
    (9, 36.103774791666666, 140.08785504166664, 11543.6883, 22916.2436),
    (15, 26.160347222222224, 127.70422777777777, 17779.0104, 20416.9652),
]
# Origins of the planes: Notification 9 of the Ministry of Land, Infrastructure, Transport and Tourism, 2002.
ORIGINS = {1: (33, 129.5), 6: (36, 136), 9: (36, 139 + 50 / 60), 12: (44, 142.25), 19: (26, 154)}


def place(x: float, y: float) -> tuple[np.ndarray, np.ndarray]:
    return np.array([x]), np.array([y])


@pytest.mark.parametrize(("plane", "latitude", "longitude", "north", "east"), PUBLISHED)
def test_published_values(plane: int, latitude: float, longitude: float, north: float, east: float) -> None:
    frame = SiteFrame(Origin(plane=plane, north=0.0, east=0.0))
    x, y = frame.to_map(*place(longitude, latitude), WGS84)
    assert (x[0], y[0]) == (pytest.approx(east, abs=1e-3), pytest.approx(north, abs=1e-3))
    back = frame.from_map(*place(east, north), WGS84)
    assert (back[0][0], back[1][0]) == (pytest.approx(longitude, abs=1e-8), pytest.approx(latitude, abs=1e-8))


@pytest.mark.parametrize("plane", ORIGINS)
def test_the_origin_of_a_plane(plane: int) -> None:
    latitude, longitude = ORIGINS[plane]
    x, y = SiteFrame(Origin(plane=plane, north=0.0, east=0.0)).to_map(*place(longitude, latitude), WGS84)
    assert (x[0], y[0]) == (pytest.approx(0, abs=1e-4), pytest.approx(0, abs=1e-4))


def test_the_map_is_moved_and_turned() -> None:
    frame = SiteFrame(Origin(plane=9, north=1000.0, east=-500.0, yaw=math.pi / 6))
    x, y = frame.to_map(*place(-500.0 + 20 * math.cos(math.pi / 6), 1000.0 + 20 * math.sin(math.pi / 6)), 6677)
    assert (x[0], y[0]) == (pytest.approx(20.0), pytest.approx(0.0, abs=1e-9))
    east, north = frame.from_map(*place(0.0, 8.0), 6677)
    assert (east[0], north[0]) == (pytest.approx(-500 - 4.0), pytest.approx(1000 + 8 * math.cos(math.pi / 6)))


def test_an_origin_by_latitude_and_longitude_has_metres_of_the_ground() -> None:
    frame = SiteFrame(Origin(latitude=36.0, longitude=140.0))
    # Length of a degree of the meridian and of the parallel at 36 degrees on WGS84, over 0.001 degree.
    x, y = frame.to_map(np.array([140.0, 140.001]), np.array([36.001, 36.0]), WGS84)
    assert (x[0], y[0]) == (pytest.approx(0, abs=1e-6), pytest.approx(110.9585, abs=2e-3))
    assert (x[1], y[1]) == (pytest.approx(90.1635, abs=2e-3), pytest.approx(0, abs=1e-2))
    back = frame.from_map(x, y, WGS84)
    assert back[0] == pytest.approx([140.0, 140.001], abs=1e-9) and back[1] == pytest.approx([36.001, 36.0], abs=1e-9)


def test_codes_that_are_refused() -> None:
    with pytest.raises(TmsError) as caught:
        crs(1)
    assert caught.value.reason == FrameUnknown(1)
    with pytest.raises(TmsError) as caught:
        crs(2263)  # New York, in feet
    assert caught.value.reason == FrameUnits(2263, "US survey foot")
