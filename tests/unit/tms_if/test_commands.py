"""What clients ask for, and what they may not."""

import json

import pytest

from tms_if.commands import CommandError, Registration, ServiceId, handshake, parse
from tms_if.interfaces import interface

GOOD = b'{"topic":"zx200/odom","message_name":"nav_msgs/Odometry","queue_size":10,"latch":false}\0'


def test_the_handshake() -> None:
    data = handshake()
    assert data.startswith(b"\x0b\0\0\0__handshake")
    reported = json.loads(data[4 + 11 + 4 :])
    assert reported == {"version": "v0.7.0", "metadata": '{"protocol": "ROS2"}'}


def test_a_registration() -> None:
    assert parse(Registration, "__publish", GOOD).queue_size == 10
    assert parse(Registration, "__publish", GOOD.replace(b":10", b":99999999")).queue_size == 1000
    assert parse(Registration, "__publish", GOOD.replace(b"zx200/odom", b"a" * 246))
    assert parse(ServiceId, "__request", b'{"srv_id": 101}\0').srv_id == 101


@pytest.mark.parametrize(
    ("payload", "why"),
    [
        (b"", "Invalid JSON"),
        (b"\xff\0", "Invalid JSON"),
        (b"[1]\0", "object"),
        (GOOD.replace(b"zx200/odom", b"zx200 odom"), "topic: "),
        (GOOD.replace(b"zx200/odom", b"a//b"), "topic: "),
        (GOOD.replace(b"zx200/odom", b"a" * 247), "topic: String should have at most 246"),
        (GOOD.replace(b"nav_msgs/Odometry", b"Odometry"), "message_name: "),
        (GOOD.replace(b'"topic"', b'"tropic"'), "topic: "),
    ],
)
def test_what_is_wrong_is_said(payload: bytes, why: str) -> None:
    with pytest.raises(CommandError, match=f"^__publish: .*{why}"):
        parse(Registration, "__publish", payload)


def test_types_by_the_names_of_the_simulator() -> None:
    from nav_msgs.msg import Odometry

    assert interface("nav_msgs/Odometry", "msg") is interface("nav_msgs/msg/Odometry", "msg") is Odometry
    assert hasattr(interface("std_srvs/Trigger", "srv"), "Request")


@pytest.mark.parametrize(
    "name", ["nav_msgs/Nothing", "no_such_msgs/Odometry", "os/path", "antigravity/X", "nav_msgs/Odometry_"]
)
def test_a_type_that_is_not_there(name: str) -> None:
    import sys

    known = set(sys.modules)
    with pytest.raises(CommandError, match=f"no {name} here"):
        interface(name, "msg")
    assert "antigravity" not in set(sys.modules) - known
