"""Inputs of a goal travel behind its record's name."""

import pytest

from tms_machine.goal_inputs import Inputs, joined, parted


@pytest.mark.parametrize("record", ["circle", "", "a,b,c", "記録 1", "what?", "a?b=c", "x&y=1", "100%"])
@pytest.mark.parametrize(
    "inputs",
    [
        {},
        {"read_direction": "down"},
        {"blade_hold": True},
        {"previous_target_record_name": "pose & more = ?"},
        {"read_direction": "{UP_DOWN}", "blade_hold": True},
    ],
)
def test_both_come_back(record: str, inputs: Inputs) -> None:
    assert parted(joined(record, inputs)) == (record, inputs)


def test_people_can_read_it() -> None:
    assert joined("circle", {"read_direction": "{UP_DOWN}"}) == "circle?read_direction={UP_DOWN}"


def test_a_name_without_inputs_stays_as_it_is() -> None:
    assert joined("circle", {}) == "circle"
    assert parted("circle?speed=3") == ("circle?speed=3", {})
