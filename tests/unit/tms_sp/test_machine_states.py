"""The poses and joints of machines that are written into the collections of the C++ system."""

import json
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

from tms_config.models import Border
from tms_sp.machine_states import MachineStateSampler

SOURCE = {"period": 0.06, "stamps": "utc", "frozen_after": 5.0, "origin": "a test"}
ODOM = {"odom": "odom", "joint_states": "joint_states", "sources": {"odom": SOURCE, "joint_states": SOURCE}}
POSE = {**ODOM, "pose": "base_link/pose", "sources": {**ODOM["sources"], "pose": SOURCE}}  # type: ignore[dict-item]
GLOBAL = {**POSE, "sources": {**POSE["sources"], "pose": {**SOURCE, "message": "Odometry"}}}  # type: ignore[dict-item]


def odometry(x: float) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x = x
    return message


def stamped(x: float) -> PoseStamped:
    message = PoseStamped()
    message.header.frame_id, message.pose.position.x = "world", x
    return message


@pytest.mark.parametrize(
    ("border", "pose"), [(ODOM, odometry(1.0)), (POSE, stamped(2.0)), (GLOBAL, odometry(2.0))],
    ids=["odometry", "pose", "pose as odometry"],
)  # fmt: skip
def test_where_it_is_comes_from_the_pose_topic_if_there_is_one(border: dict[str, Any], pose: Any) -> None:
    says: dict[str, Any] = {"/m/odom": odometry(1.0), "/m/joint_states": JointState(name=["boom_joint"])}
    if "pose" in border:
        says["/m/base_link/pose"] = pose
    written: list[Any] = []

    def sample(kind: Any, topic: str) -> Any:
        assert isinstance(says[topic], kind)
        return lambda: [says[topic]]

    ros: Any = SimpleNamespace(
        sample=sample, every=lambda _, step: step(), now=lambda: Odometry().header.stamp,
        call_then=lambda _type, _name, request, _then: written.extend(request.states),
    )  # fmt: skip
    site: Any = SimpleNamespace(
        file=SimpleNamespace(machines={"m": None}), border=lambda _: Border.model_validate(border)
    )
    MachineStateSampler(SimpleNamespace(ros=ros, site=site), 1.0)  # type: ignore[arg-type]
    place, joints = (json.loads(one.msg) for one in written)
    assert place["pose"]["pose"]["position"]["x"] == (2.0 if "pose" in border else 1.0)
    assert joints["name"] == ["boom_joint"]
