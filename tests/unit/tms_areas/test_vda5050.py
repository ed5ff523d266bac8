"""The export as a zoneSet of VDA 5050 3.0.0: what its schema asks for, and the same places are closed."""

import copy
import json
from collections.abc import Callable
from typing import Any

import jsonschema_rs
import pytest
from shapely import Point, Polygon

from conftest import PROJECT
from tms_areas.areas import Area, AreaSet
from tms_areas.vda5050 import zone_set

SCHEMA = jsonschema_rs.validator_for(
    json.loads((PROJECT / "tests/data" / "vda5050_zone_set.json").read_text(encoding="utf-8"))
)
RING = Area("ring", "unmanned", ((0, 0), (40, 0), (40, 30), (0, 30), (0, 20), (30, 20), (30, 10), (0, 10)))
LID = Area("lid", "unmanned", ((-5, 0), (0, 0), (0, 30), (-5, 30)))  # closes the ring: a hole remains
AREAS = AreaSet((
    Area("dump", "release", ((30, 0), (40, 0), (40, 10), (30, 10)), "積込場", on_loss="evacuate"), LID,
    Area("people", "manned", ((1, 1), (5, 1), (5, 5))), RING,
    Area("slow", "speed_limit", ((10, 20), (20, 20), (20, 30), (10, 30)), speed=0.5),
))  # fmt: skip


def test_it_has_what_the_schema_asks_for() -> None:
    told = zone_set(AREAS, "yard", "2026-11-26T00:00:00.000Z")
    SCHEMA.validate(json.loads(json.dumps(told)))
    zones = told["zoneSet"]["zones"]
    assert len({zone["zoneId"] for zone in zones}) == len(zones)
    for zone in zones:
        shape = Polygon([(one["x"], one["y"]) for one in zone["vertices"]])
        assert shape.is_valid and shape.exterior.is_ccw
    release = next(zone for zone in zones if zone["zoneType"] == "RELEASE")
    assert (release["releaseLossBehavior"], release["zoneDescriptor"]) == ("EVACUATE", "積込場")


SPOILED: list[Callable[[Any], object]] = [
    lambda told: told.pop("headerId"), lambda told: told.update(timestamp="yesterday"),
    lambda told: told["zoneSet"].pop("zoneSetId"), lambda told: told["zoneSet"].update(zones={}),
    lambda told: told["zoneSet"]["zones"][0].update(zoneType="MOAT"),
    lambda told: told["zoneSet"]["zones"][0].update(vertices=[{"x": 0.0, "y": 0.0}] * 2),
    lambda told: told["zoneSet"]["zones"][0]["vertices"][0].pop("y"),
    lambda told: [zone.pop("maximumSpeed", None) for zone in told["zoneSet"]["zones"]],
    lambda told: [zone.update(releaseLossBehavior="STOP") for zone in told["zoneSet"]["zones"]],
]  # fmt: skip


@pytest.mark.parametrize("spoil", SPOILED)
def test_the_schema_refuses_what_is_spoiled(spoil: Callable[[Any], object]) -> None:
    told = copy.deepcopy(zone_set(AREAS, "yard", "2026-11-26T00:00:00.000Z"))
    assert SCHEMA.is_valid(told)
    spoil(told)
    assert not SCHEMA.is_valid(told)


def test_its_zones_close_what_our_areas_close() -> None:
    zones = zone_set(AREAS, "yard", "")["zoneSet"]["zones"]
    closed = [
        Polygon([(one["x"], one["y"]) for one in zone["vertices"]])
        for zone in zones
        if zone["zoneType"] in ("BLOCKED", "RELEASE")
    ]
    usable = AREAS.usable()
    places = [Point(x + 0.5, y + 0.3) for x in range(-20, 60, 2) for y in range(-20, 50, 2)]
    assert [any(shape.contains(one) for shape in closed) for one in places] == [
        not usable.contains(one) for one in places
    ]
