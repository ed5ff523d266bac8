"""The planner's neighbours on a real /tf."""

from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from conftest import wait_until
from tms_config.config import CONFIGS
from tms_config.models import Border, Box, MachineModel
from tms_config.yaml_file import parse
from tms_ros.node import Ros
from tms_rp.neighbours import Neighbours

pytestmark = pytest.mark.ros
BODY = Box(min=(-3.0, -1.3, 0.0), max=(2.0, 1.3, 3.0))
TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel).model_copy(
    update={"footprint": {"body": BODY}, "shapes": {}}
)
MACHINES = ("zx200", "ic120")


def reported(*frames: str, x: float) -> TFMessage:
    """The same place of some frames in the map."""
    message = TFMessage(transforms=[TransformStamped(child_frame_id=frame) for frame in frames])
    for one in message.transforms:
        one.header.frame_id, one.transform.translation.x, one.transform.rotation.w = "map", x, 1.0
    return message


def test_a_place_that_is_told_now_and_then_is_heard_among_all_the_joints(two_nodes: tuple[Ros, Ros]) -> None:
    nav, planner = two_nodes
    site: Any = SimpleNamespace(
        border=lambda name: Border(base_frame=f"{name}/base"),
        file=SimpleNamespace(machines=MACHINES),
        model_of=lambda _: TRUCK,
    )
    app: Any = SimpleNamespace(site=site, machine="zx200", log=structlog.stdlib.get_logger("test"), ros=planner)
    neighbours = Neighbours(app)
    say = nav.publisher(TFMessage, "/tf", depth=200)
    places = lambda: [one.place[0, 3] for one in neighbours.scene().obstacles]  # noqa: E731
    wait_until(
        lambda: say.publish(reported("zx200/base", "ic120/base", x=0.0)) or places() == [0.0], 30, "both are heard"
    )
    say.publish(reported("ic120/base", x=7.0))
    for number in range(150):
        say.publish(reported(f"joint_{number}", x=0.0))
    wait_until(lambda: places() == [7.0], 20, "the truck is seen to have gone on")
