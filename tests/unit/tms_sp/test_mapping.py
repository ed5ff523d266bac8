"""From messages to values of a record, and every reason why not."""

import math
from array import array
from types import SimpleNamespace as Message
from typing import Any

import pytest
from pydantic import ValidationError

from tms_machine.sensing import Input
from tms_reason.validation import Wrong
from tms_sp.mapping import Mapping, MessageRefused

EXCAVATE = {"model_name": "string", "record_name": "string", "x": "double", "y": "double"}
WAYPOINTS = {"model_name": "string", "record_name": "string", "x": "sequence<double>", "y": "sequence<double>"}
JOINTS = {"header": "std_msgs/Header", "name": "sequence<string>", "position": "sequence<double>"}
HEAD = {"model_name": "zx200", "record_name": "p"}


# A stamped pose, and what is inside its parts.
POSE = {"header": "std_msgs/Header", "pose": "geometry_msgs/Pose", "covariance": "double[36]"}
INSIDE = {
    "std_msgs/Header": {"stamp": "builtin_interfaces/Time", "frame_id": "string"},
    "builtin_interfaces/Time": {"sec": "int32", "nanosec": "uint32"},
    "geometry_msgs/Pose": {"position": "geometry_msgs/Point", "orientation": "geometry_msgs/Quaternion"},
    "geometry_msgs/Point": {"x": "double", "y": "double", "z": "double"},
}


def mapping(message: dict[str, str], /, **given: Any) -> Mapping:
    return Mapping(Input.model_validate({"topic": "/t", "type": "a/msg/B", **given}), message, INSIDE.__getitem__)


def joints(*positions: float) -> Message:
    header = Message(stamp=Message(sec=10, nanosec=500_000_000))
    return Message(header=header, name=["swing", "boom"], position=array("d", positions))


def test_every_field_goes_into_the_field_of_its_name() -> None:
    reading = mapping(EXCAVATE).read(Message(**HEAD, x=1.5, y=2.0))
    assert (reading.key, reading.values, reading.stamp) == (("zx200", "p"), {"x": 1.5, "y": 2.0}, None)


def test_arrays_become_lists_and_belong_together() -> None:
    given = mapping(WAYPOINTS)
    assert given.read(Message(**HEAD, x=array("d", [1, 2]), y=array("d", [3, 4]))).values == {"x": [1, 2], "y": [3, 4]}
    for x, y in (([1.0], [1.0, 2.0]), ([], [])):
        with pytest.raises(MessageRefused) as refused:
            given.read(Message(**HEAD, x=array("d", x), y=array("d", y)))
        assert refused.value.code == ("SIZES_DIFFER" if x else "NO_VALUES")


def test_fields_of_its_own_with_units_elements_and_names() -> None:
    fields = {"angle": {"path": "position[swing]", "unit": "deg"}, "second": "position[1]"}
    given = mapping(JOINTS, model="zx200", record="seen", fields=fields)
    reading = given.read(joints(180.0, 0.25))
    assert reading.key == ("zx200", "seen")
    assert reading.values == {"angle": pytest.approx(math.pi), "second": 0.25}
    assert reading.stamp == 10.5
    with pytest.raises(MessageRefused, match="no such element among 1"):
        given.read(joints(1.0))


@pytest.mark.parametrize(
    ("message", "code", "said"),
    [
        ({"x": math.nan, "y": 0.0}, "VALUE_NOT_FINITE", "x is nan"),
        ({"x": math.inf, "y": 0.0}, "VALUE_NOT_FINITE", "x is inf"),
        ({"x": 9.0, "y": 0.0}, "VALUE_OUT_OF_RANGE", "x is 9.000, not from -5.000 to 5.000"),
        ({"x": 0.0, "y": 0.0, "record_name": " "}, "NAMES_NO_RECORD", "names no record"),
        ({"x": 0.0, "y": 2**63}, "VALUE_TOO_LARGE", "y is 9223372036854775808, the largest whole number is"),
        ({"x": 0.0, "y": [1, 2**64 - 1]}, "VALUE_TOO_LARGE", "y is 18446744073709551615"),
        (
            {"x": 0.0, "y": Message(z=1.0)},
            "NO_VALUE_OF",
            "y is a SimpleNamespace, not a number, text, true/false or an",
        ),
        ({"x": 0.0, "y": [Message(z=1.0)]}, "NO_VALUE_OF", "y is a list, not a number"),
        ({"x": 0.0, "y": b"\x01"}, "NO_VALUE_OF", "y is a bytes, not a number"),
    ],
)
def test_what_is_refused(message: dict[str, Any], code: str, said: str) -> None:
    with pytest.raises(MessageRefused, match=said) as refused:
        mapping(EXCAVATE, range={"x": [-5, 5]}).read(Message(**{**HEAD, **message}))
    assert refused.value.code == code


def test_a_size_that_is_declared() -> None:
    given = mapping(JOINTS, model="m", record="r", fields={"all": {"path": "position", "size": 2}})
    assert given.read(joints(1.0, 2.0)).values == {"all": [1.0, 2.0]}
    with pytest.raises(MessageRefused, match="all has 3 values, not 2"):
        given.read(joints(1.0, 2.0, 3.0))


def test_fields_that_stay() -> None:
    fields = {"record_name": "string", "loaded_flg": "boolean", "keep_val_flgs": "sequence<string>"}
    given = mapping(fields, model="", keep="keep_val_flgs")
    reading = given.read(Message(record_name="F", loaded_flg=True, keep_val_flgs=["LOADED_FLG"]))
    assert (reading.key, reading.values, reading.keep) == (("", "F"), {"loaded_flg": True}, ("LOADED_FLG",))


def test_a_message_without_the_field_is_told_before_anything_starts() -> None:
    with pytest.raises(Wrong, match="the message has no field 'z'; it has model_name"):
        mapping(EXCAVATE, fields={"z": "z"})


@pytest.mark.parametrize(
    ("fields", "given", "said"),
    [
        (POSE, {"fields": {"p": "pose.position"}}, "pose.position is a geometry_msgs/Point, not a number, text, "
         "true/false or an array of these; inside it: pose.position.x, pose.position.y, pose.position.z; Name under"),
        (POSE, {"fields": {"p": "pose"}}, "pose is a geometry_msgs/Pose, not a number"),
        (POSE, {}, "pose is a geometry_msgs/Pose, not a number, text, true/false or an array of these; inside it: "
         "pose.position, pose.orientation; Name under `fields` what is wanted"),
        (POSE, {"fields": {"p": "pose.position.a"}}, "no field 'pose.position.a'; it has x, y, z"),
        (POSE, {"fields": {"p": "pose.position.x.a"}}, "there is no 'a' in a double"),
        (POSE, {"fields": {"p": "pose.position.x[0]"}}, "x is a double, no array"),
        (POSE, {"fields": {"p": "covariance[x]"}}, "no array of texts called 'name' beside covariance"),
        (POSE, {"fields": {"p": "header.stamp"}}, "header.stamp is a builtin_interfaces/Time.*header.stamp.nanosec"),
        ({"p": "sequence<geometry_msgs/Point>"}, {}, r"p is a geometry_msgs/Point\[\], not .* inside it: p\[0\].x"),
        ({"p": "octet"}, {}, "p is a octet, not a number"),
        (POSE, {"fields": {"x": "pose.position.x"}, "record": "$pose"}, "pose is a geometry_msgs/Pose, not a text or"),
        (POSE, {"fields": {"x": "pose.position.x"}, "keep": "covariance"}, r"covariance is a double\[\], not an array"),
        (POSE, {"fields": {"x": "pose.position.x"}, "stamp": "header.frame_id"}, "header.frame_id is a string, not a"),
    ],
)  # fmt: skip
def test_a_field_that_no_record_can_hold_is_told_before_anything_starts(
    fields: dict[str, str], given: dict[str, Any], said: str
) -> None:
    with pytest.raises(Wrong, match=said):
        mapping(fields, **{"model": "m", "record": "r", **given})


@pytest.mark.parametrize(
    ("kind", "path"),
    [
        ("boolean", "a"), ("uint64", "a"), ("float", "a"), ("wstring", "a"), ("string<10>", "a"),
        ("sequence<double, 3>", "a"), ("sequence<string<5>, 3>", "a"), ("double[9]", "a"), ("uint8[4]", "a[2]"),
        ("sequence<geometry_msgs/Point>", "a[0].x"), ("geometry_msgs/Pose", "a.position.z"),
    ],
)  # fmt: skip
def test_a_field_that_a_record_can_hold_is_taken(kind: str, path: str) -> None:
    mapping({"a": kind, "b": "int8"}, model="m", record="r", fields={"f": path})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"range": {"x": [5, -5]}}, r"must be \[least, most\]"),
        ({"fields": {"a": "x"}, "range": {"b": [0, 1]}}, "no such field under fields"),
        ({"fields": {"a": {"path": "x", "unit": "mile"}}}, "no unit 'mile'"),
        ({"fields": {"a": "x; y"}}, "pattern"),
        ({"rate": 5}, "Extra inputs"),
        ({"type": "std_msgs/Float64"}, "pattern"),
    ],
)
def test_what_sensing_yaml_must_not_hold(given: dict[str, Any], said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        mapping(EXCAVATE, **given)


@pytest.mark.parametrize("stamp", [math.nan, math.inf, -math.inf])
def test_a_stamp_that_is_no_time_is_refused(stamp: float) -> None:
    given = mapping({**EXCAVATE, "measured": "double"}, fields={"x": "x"}, stamp="measured")
    with pytest.raises(MessageRefused, match=f"its stamp is {stamp}") as refused:
        given.read(Message(**HEAD, x=1.0, measured=stamp))
    assert refused.value.code == "STAMP_NOT_FINITE"
