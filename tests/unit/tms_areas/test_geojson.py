"""Areas from files: what is accepted, what it becomes, and why the rest is refused."""

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_areas import checks
from tms_areas.areas import Area, AreaSet, Point
from tms_areas.geojson import gathered, read, written
from tms_areas.reasons import (
    AreaFileLarge,
    AreaTwice,
    CrossesItself,
    FewCorners,
    HasHole,
    ManyAreas,
    ManyCorners,
    NeedsNoLoss,
    NeedsSpeed,
    NoJson,
    NoOriginForAreas,
    NothingUsable,
    NoUnmanned,
    OtherCoordinates,
    RingOpen,
    TooFar,
    TooSmall,
)
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_reason.reasons import MissingKey, MustBeFinite, MustBeOneOf, UnknownKey

YARD = [(0, 0), (40, 0), (40, 30), (0, 30)]


def feature(corners: list[Any], area: str = "yard", kind: str = "unmanned", **more: Any) -> dict[str, Any]:
    ring = [list(one) for one in (*corners, corners[0])]
    return {
        "type": "Feature", "properties": {"id": area, "type": kind, **more},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }  # fmt: skip


def document(*features: dict[str, Any], **more: Any) -> str:
    return json.dumps({"type": "FeatureCollection", "frame": "map", "features": list(features), **more})


def one_set(*features: dict[str, Any]) -> AreaSet:
    return gathered([read(document(*features), "a.geojson", None)])


def refused(text: str) -> Reason:
    with pytest.raises(ConfigError) as caught:
        gathered([read(text, "a.geojson", None)])
    return caught.value.reason


def test_an_area_in_map() -> None:
    (yard,) = one_set(feature(YARD)).areas
    assert yard == Area("yard", "unmanned", ((0, 0), (40, 0), (40, 30), (0, 30)))


def test_the_same_polygon_has_the_same_id_wherever_it_begins_and_whichever_way_it_runs() -> None:
    ids = {one_set(feature(corners)).id for corners in (YARD, YARD[2:] + YARD[:2], YARD[::-1])}
    assert len(ids) == 1


@pytest.mark.parametrize("more", [{"name": "x"}, {"id": "other"}, {"type": "release"}])
def test_a_set_that_says_something_else_has_another_id(more: dict[str, Any]) -> None:
    island = feature([(1, 1), (5, 1), (5, 5)], "b", "blocked")
    other = {**island, "properties": {**island["properties"], **more}}
    assert one_set(feature(YARD), island).id != one_set(feature(YARD), other).id


def test_what_is_written_reads_as_the_same_set() -> None:
    areas = one_set(
        feature(YARD), feature([(30, 0), (50, 0), (50, 9)], "road", "speed_limit", maximum_speed=0.5, name="坂道"),
        feature([(1, 1), (5, 1), (5, 5)], "dump", "release", on_loss="evacuate"),
    )  # fmt: skip
    assert gathered([read(json.dumps(written(areas)), "b.geojson", None)]) == areas


def test_latitude_and_longitude_pass_through_the_frame_of_the_site() -> None:
    text = document(feature([(139.0, 35.0), (139.001, 35.0), (139.001, 35.001)]), frame="WGS84")
    metres = lambda lon, lat: ((np.asarray(lon) - 139.0) * 1e5, (np.asarray(lat) - 35.0) * 1e5)  # noqa: E731
    (area,) = read(text, "a.geojson", metres)
    assert area.corners == ((0, 0), (100, 0), (100, 100))
    assert refused(text).find(NoOriginForAreas) is not None


def test_a_set_is_usable_where_no_other_area_forbids_it() -> None:
    areas = one_set(
        feature(YARD), feature([(0, 0), (10, 0), (10, 30), (0, 30)], "people", "manned"),
        feature([(30, 0), (40, 0), (40, 30), (30, 30)], "place", "release"),
    )  # fmt: skip
    assert areas.usable().area == pytest.approx(20 * 30)
    assert areas.usable(frozenset({"place"})).area == pytest.approx(30 * 30)


ring_of = lambda n, r=20.0: [(r * math.cos(i), r * math.sin(i)) for i in np.linspace(0, math.tau, n, False)]  # noqa: E731
WRONG: list[tuple[type[Reason], str]] = [
    (NoJson, '{"type": '),
    (NoJson, "[" * 100_000),
    (AreaFileLarge, " " * 2_000_001),
    (MissingKey, '{"type": "FeatureCollection"}'),
    (MustBeOneOf, document(feature(YARD, kind="unmaned"))),
    (UnknownKey, document(feature(YARD, maximumspeed=1))),
    (MustBeFinite, document(feature([(0, 0), (math.nan, 0), (1, 1)]))),
    (MustBeFinite, document(feature([(0, 0), (math.inf, 0), (1, 1)]))),
    (OtherCoordinates, document(feature(YARD), crs={"properties": {"name": "urn:ogc:def:crs:EPSG::6677"}})),
    (CrossesItself, document(feature([(0, 0), (10, 10), (10, 0), (0, 10)]))),
    (CrossesItself, document(feature([(0, 0), (10, 0), (10, 10), (5, 0), (0, 10)]))),  # touches
    (FewCorners, document(feature([(0, 0), (10, 0), (10, 0.0001)]))),
    (ManyCorners, document(feature(ring_of(201)))),
    (TooSmall, document(feature([(0, 0), (1, 0), (1, 1)]))),
    (TooFar, document(feature([(0, 0), (10_001, 0), (10, 10)]))),
    (NeedsSpeed, document(feature(YARD, kind="speed_limit"))),
    (NeedsSpeed, document(feature(YARD, maximum_speed=1.0))),
    (NeedsNoLoss, document(feature(YARD, on_loss="stop"))),
    (AreaTwice, document(feature(YARD), feature(YARD))),
    (ManyAreas, document(*(feature(YARD, f"a{i}") for i in range(101)))),
    (NoUnmanned, document(feature(YARD, kind="blocked"))),
    (NothingUsable, document(feature(YARD), feature(YARD, "all", "manned"))),
]


@pytest.mark.parametrize(("kind", "text"), WRONG, ids=lambda one: getattr(one, "__name__", ""))
def test_what_is_refused(kind: type[Reason], text: str) -> None:
    assert refused(text).find(kind) is not None


def test_a_crossing_is_told_with_its_place() -> None:
    found = refused(document(feature([(0, 0), (10, 10), (10, 0), (0, 10)]))).find(CrossesItself)
    assert found is not None and (found.x, found.y) == (pytest.approx(5), pytest.approx(5))


def test_an_open_ring_and_a_hole() -> None:
    opened, holed = feature(YARD), feature(YARD)
    opened["geometry"]["coordinates"][0].pop()
    holed["geometry"]["coordinates"].append([[1, 1], [2, 1], [2, 2], [1, 1]])
    assert refused(document(opened)).find(RingOpen) is not None
    assert refused(document(holed)).find(HasHole) is not None


@given(st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=3, max_size=9))
def test_whatever_is_drawn_is_refused_with_a_reason_or_makes_a_simple_polygon(corners: list[Point]) -> None:
    if checks.area_flaw("unmanned", corners, None, None) is None:
        (area,) = one_set(feature(corners)).areas
        assert area.polygon.is_valid and area.polygon.area >= checks.SMALLEST
