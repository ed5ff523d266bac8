"""Where frames stand in the map, directly and through others."""

import math
from typing import Any

import pytest
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from tms_machine.frames import Frames


def reported(parent: str, child: str, x: float, y: float = 0.0, yaw: float = 0.0) -> Any:
    one = TransformStamped(child_frame_id=child)
    one.header.frame_id = parent
    one.transform.translation.x, one.transform.translation.y = x, y
    one.transform.rotation.z, one.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return TFMessage(transforms=[one])


def test_a_frame_below_odom_as_a_real_navigation_tells_it() -> None:
    frames = Frames(["base_link"])
    for _ in range(2):  # what is above the frame is known once the frame was heard
        frames.receive(reported("map", "odom", 10.0, 5.0, math.pi / 2))
        frames.receive(reported("odom", "base_link", 2.0, 1.0, math.pi))
    seen = frames.place("base_link")
    assert seen is not None and seen[:3] == pytest.approx((9.0, 7.0, -math.pi / 2))


def test_a_place_is_as_old_as_the_oldest_of_what_tells_it() -> None:
    now = [1.0]
    frames = Frames(["base_link"], lambda: now[0])
    frames.receive(reported("odom", "base_link", 2.0))
    frames.receive(reported("map", "odom", 10.0))
    now[0] = 9.0
    frames.receive(reported("odom", "base_link", 3.0))  # odometry goes on, the localisation does not
    assert frames.place("base_link") == (13.0, 0.0, 0.0, 1.0)
    frames.receive_fixed(reported("map", "odom", 20.0))
    assert frames.place("base_link") == (23.0, 0.0, 0.0, 9.0)


def test_what_is_fixed_is_told_once_before_anybody_asks() -> None:
    frames = Frames(["base_link"])
    frames.receive_fixed(reported("map", "odom", 10.0))
    frames.receive(reported("odom", "base_link", 2.0))
    seen = frames.place("base_link")
    assert seen is not None and seen.x == 12.0


def test_what_does_not_lead_to_the_map_is_nowhere() -> None:
    frames = Frames(["base_link"])
    assert frames.place("base_link") is None
    frames.receive(reported("odom", "base_link", 2.0))
    assert frames.place("base_link") is None
    frames.receive(reported("base_link", "odom", 2.0))  # a ring
    assert frames.place("base_link") is None


def test_frames_of_nobody_and_places_that_are_no_numbers_are_left_out() -> None:
    frames = Frames(["base_link"])
    assert frames.receive(reported("map", "base_link", 7.0)) == {"base_link"}
    assert frames.receive(reported("base_link", "bucket_link", 1.0)) == set()
    assert frames.receive(reported("map", "base_link", math.nan)) == set()
    seen = frames.place("base_link")
    assert seen is not None and seen[:3] == (7.0, 0.0, 0.0)
    assert frames.place("bucket_link") is None
