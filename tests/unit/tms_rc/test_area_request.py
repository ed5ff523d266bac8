"""A request to enable areas is refused, with a reason, whatever of it is missing, of another type or wrong."""

import json
from typing import Any

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue

from tms_areas.areas import Area, AreaSet
from tms_areas.geojson import written
from tms_rc.area_request import area_request
from tms_reason import texts
from tms_reason.errors import TmsError

YARD = AreaSet((Area("yard", "unmanned", ((0.0, 0.0), (9.0, 0.0), (9.0, 9.0)), "置場"),))
DOCUMENT = written(YARD)
WHOLE: dict[str, Any] = {"id": YARD.id, "areas": json.dumps(DOCUMENT), "who": "a person", "only_check": False}


def parameters(told: dict[str, Any]) -> list[Parameter]:
    return [Parameter(name=name, value=value(one)) for name, one in told.items()]


def value(told: Any) -> ParameterValue:
    if isinstance(told, bool):
        return ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=told)
    if isinstance(told, str):
        return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=told)
    return ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=told)


def refused(some: list[Parameter]) -> str:
    with pytest.raises(TmsError) as caught:
        area_request(some)
    return texts.text(caught.value.reason, "en")


def feature(**changes: Any) -> str:
    (one,) = DOCUMENT["features"]
    return json.dumps({**DOCUMENT, "features": [{**one, **changes}]})


def test_a_whole_request_is_taken() -> None:
    asked = area_request(parameters(WHOLE))
    assert asked.areas == YARD and asked.who == "a person" and not asked.only_check


@pytest.mark.parametrize("name", WHOLE)
def test_a_parameter_is_missing(name: str) -> None:
    said = refused(parameters({key: one for key, one in WHOLE.items() if key != name}))
    assert name in said and "is missing" in said


@pytest.mark.parametrize("name", WHOLE)
@pytest.mark.parametrize("other", [7, True, "yes"])
def test_a_parameter_is_of_another_type(name: str, other: Any) -> None:
    if type(other) is not type(WHOLE[name]):
        assert name in refused(parameters({**WHOLE, name: other}))


def test_a_parameter_is_unknown_or_comes_twice() -> None:
    assert "force" in refused(parameters({**WHOLE, "force": True}))
    assert "twice" in refused([*parameters(WHOLE), *parameters({"who": "another person"})])


@pytest.mark.parametrize("who", ["", "  ", "a\nperson", "a\x1b[31mperson"])
def test_nobody_has_asked(who: str) -> None:
    assert "who" in refused(parameters({**WHOLE, "who": who}))


@pytest.mark.parametrize("told", ["", "x", YARD.id.upper(), YARD.id[:-1]])
def test_other_areas_were_shown(told: str) -> None:
    assert "shown" in refused(parameters({**WHOLE, "id": told}))


@pytest.mark.parametrize(
    "areas",
    [
        "", "null", "[]", "{}", "7", "[" * 100_000, '{"type": "FeatureCollection", "features": 3}',
        json.dumps({**DOCUMENT, "features": []}), json.dumps({**DOCUMENT, "features": DOCUMENT["features"] * 2}),
        json.dumps({**DOCUMENT, "frame": "WGS84"}), json.dumps({**DOCUMENT, "crs": {"properties": "x"}}),
        feature(properties={"id": 7, "type": "unmanned"}), feature(properties={"id": "a b", "type": "unmanned"}),
        feature(properties={"id": "yard", "type": "moat"}), feature(properties={"id": "yard"}),
        feature(properties=None),
        feature(properties={"id": "yard", "type": "unmanned", "name": "\ud800"}), feature(geometry=None),
        feature(geometry={"type": "Polygon", "coordinates": []}),
        feature(geometry={"type": "Polygon", "coordinates": [[[0, 0], [9, "x"], [9, 9], [0, 0]]]}),
        feature(geometry={"type": "Polygon", "coordinates": [[[0, 0], [9, 10**400], [9, 9], [0, 0]]]}),
        feature(geometry={"type": "Polygon", "coordinates": [[[0, 0], [9, float("nan")], [9, 9], [0, 0]]]}),
        feature(geometry={"type": "Polygon", "coordinates": [[[0, 0], [9], [9, 9], [0, 0]]]}),
        feature(geometry={"type": "MultiPolygon", "coordinates": []}),
    ],
    ids=lambda text: text[:60],
)  # fmt: skip
def test_the_areas_are_malformed(areas: str) -> None:
    refused(parameters({**WHOLE, "areas": areas}))
