"""Records of places: quaternions and degrees mean the same, and what is missing or does not fit is named."""

import math

import pytest
from pydantic import ValidationError

from tms_reason.validation import explain
from tms_subtasks.records.places import PathRecord, PoseRecord
from words import words

QUATERNION = {"qx": 0.0, "qy": 0.0, "qz": 0.70711, "qw": 0.70711}
LISTS = {"x": [1.0, 2.0], "y": [0.0, 0.0], "z": [0.0, 0.0]}


def said(model: type[PoseRecord] | type[PathRecord], **fields: object) -> str:
    with pytest.raises(ValidationError) as caught:
        model.model_validate(fields)
    return words(explain(caught.value))


def test_degrees_go_where_the_quaternion_goes() -> None:
    turned = PoseRecord.model_validate({"x": 1, "y": 2.0, **QUATERNION}).pose()
    degrees = PoseRecord.model_validate({"x": 1, "y": 2.0, "yaw": 90, "angles": "degrees"}).pose()
    for pose in (turned, degrees):
        assert (pose.position.x, pose.position.y) == (1.0, 2.0)
        assert 2 * math.atan2(pose.orientation.z, pose.orientation.w) == pytest.approx(math.pi / 2, abs=1e-5)


@pytest.mark.parametrize("name", ["x", "y", *QUATERNION])
def test_a_missing_field_is_named(name: str) -> None:
    fields = {"x": 1.0, "y": 2.0, **QUATERNION}
    del fields[name]
    assert name in said(PoseRecord, **fields)


def test_a_record_in_the_other_notation_is_refused() -> None:
    assert said(PoseRecord, x=1.0, y=2.0, yaw=90.0) == "field 'qx' is missing"
    assert said(PoseRecord, x=1.0, y=2.0, angles="degrees", **QUATERNION) == "field 'yaw' is missing"
    assert said(PathRecord, **LISTS, angles="degrees") == "field 'yaw' is missing"


@pytest.mark.parametrize(("way", "places"), [("down", [2.0, 1.0]), ("up", [1.0, 2.0]), ("", [1.0, 2.0])])
def test_a_path_is_read_up_or_down(way: str, places: list[float]) -> None:
    fields = {**LISTS, "yaw": [0.0, 90.0], "angles": "degrees", "read_direction": way}
    poses = PathRecord.model_validate(fields).poses()
    assert [pose.position.x for pose in poses] == places
    assert [bool(pose.orientation.z) for pose in poses] == [one == 2.0 for one in places]


def test_no_quaternion() -> None:
    assert "length 0.000" in said(PoseRecord, x=1.0, y=2.0, qx=0.0, qy=0.0, qz=0.0, qw=0.0)


def test_lists_of_unequal_length_are_refused_with_their_lengths() -> None:
    assert said(PathRecord, **LISTS, angles="degrees", yaw=[0.0]) == "the lists differ in length: x 2, y 2, z 2, yaw 1"
    assert said(PathRecord, x=[], y=[], z=[], yaw=[], angles="degrees") == "the path is empty"
    assert "x" in said(PathRecord, **{**LISTS, "x": 1.0}, angles="degrees", yaw=[0.0, 0.0])


def test_further_fields_do_not_matter() -> None:
    fields = {**LISTS, "yaw": [0, 90], "angles": "degrees", "description": "x", "timestamps": 3}
    assert len(PathRecord.model_validate(fields).poses()) == 2
