"""Roads of records: sections in turn, and a refusal that names what is wrong."""

from collections.abc import Mapping

import pytest

from tms_control.roads import MOST, Roads
from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_mc.reasons import ManyPlaces, RoadShort, RoadUnfit, SectionUnfit
from tms_mc.road_records import RECORD, roads
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason

SECTIONS: dict[str, Mapping[str, Value]] = {
    "3725960300000": {"x": 0.0, "y": 5.0, "label": "main"},
    "3725960300001": {"x": 10, "y": 5.0},
    "PATH": {"x": [10.0, 20.0, 30.0], "y": [5.0, 6.0, 7.0], "z": [0.0, 0.0, 0.0]},
    "odd": {"x": [10.0, 20.0], "y": [5.0]},
    "word": {"x": "10", "y": 5.0},
    "empty": {"x": [], "y": []},
    "far": {"x": [0.0, 1e9], "y": [0.0, 0.0]},
}


def test_sections_in_turn_are_a_road() -> None:
    found = roads({"haul": ["3725960300000", "3725960300001", "PATH"], "other": ["PATH"]}, SECTIONS.get)
    assert found == Roads(
        (((0.0, 5.0), (10.0, 5.0), (20.0, 6.0), (30.0, 7.0)), ((10.0, 5.0), (20.0, 6.0), (30.0, 7.0)))
    )


@pytest.mark.parametrize(
    ("value", "why"),
    [
        ("PATH", RoadUnfit("haul")),
        ([], RoadUnfit("haul")),
        ([1.0, 2.0], RoadUnfit("haul")),
        (["3725960300000"], RoadShort("haul")),
        (["PATH", "nobody"], SectionUnfit("nobody")),
        (["odd"], SectionUnfit("odd")),
        (["word"], SectionUnfit("word")),
        (["empty"], SectionUnfit("empty")),
        (["far"], ManyPlaces(200_000_001, MOST)),
    ],
)
def test_what_makes_no_road_is_refused(value: Value, why: Reason) -> None:
    with pytest.raises(SubtaskFailed) as caught:
        roads({"haul": value}, SECTIONS.get)
    assert caught.value.reason == BadRecord(RECORD, why)
