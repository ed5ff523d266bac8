"""The planner's neighbours on a real /tf."""

import logging
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from conftest import wait_until
from tms_core.ros import Ros
from tms_rp.neighbours import Neighbours

pytestmark = pytest.mark.ros
MACHINES = ("zx200", "ic120")


def told(*frames: str) -> TFMessage:
    message = TFMessage(transforms=[TransformStamped(child_frame_id=frame) for frame in frames])
    for one in message.transforms:
        one.header.frame_id = "map"
    return message


def test_a_place_that_is_told_now_and_then_is_heard_among_all_the_joints(two_nodes: tuple[Ros, Ros]) -> None:
    nav, planner = two_nodes
    site: Any = SimpleNamespace(
        border=lambda name: SimpleNamespace(base_frame=f"{name}/base"),
        file=SimpleNamespace(machines=MACHINES),
        model_of=lambda _: SimpleNamespace(footprint={"body": object()}),
    )
    app: Any = SimpleNamespace(site=site, machine="zx200", log=logging.getLogger("test"), ros=planner)
    neighbours = Neighbours(app)
    say = nav.publisher(TFMessage, "/tf", depth=200)
    wait_until(lambda: say.get_subscription_count() == 1, 30, "the planner listens")
    say.publish(told("zx200/base", "ic120/base"))
    for number in range(150):
        say.publish(told(f"joint_{number}"))
    wait_until(lambda: [one.name for one in neighbours.obstacles()] == ["body of ic120"], 20, "the truck is seen")
