"""Writes pose and joints of the site's machines at a low rate into the collections that the C++ system reads."""

import json
from collections.abc import Callable, Sequence
from typing import Any

from geometry_msgs.msg import PoseStamped, PoseWithCovariance
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from tms_msg_db.msg import MachineState
from tms_msg_db.srv import WriteMachineStates

from tms_config.models import Border
from tms_interfaces.generated import Message
from tms_machine.places import POSES, pose_of
from tms_runtime.app import App


class MachineStateSampler:
    """Samples the topics of all machines; messages between two samples cost nothing."""

    def __init__(self, app: App, hz: float) -> None:
        self._ros = app.ros
        self._topics: list[tuple[str, str, Callable[[], Sequence[Message]]]] = []
        for machine in app.site.file.machines:
            border = app.site.border(machine)
            if (pose := _pose_topic(border)) is not None:
                self._topics.append(("machine_pose", machine, app.ros.sample(pose[0], f"/{machine}/{pose[1]}")))
            if border.joint_states:
                topic = f"/{machine}/{border.joint_states}"
                self._topics.append(("machine_joints", machine, app.ros.sample(JointState, topic)))
        self._waiting = False
        if self._topics:
            app.ros.every(1.0 / hz, self._write_due)

    def _write_due(self) -> None:
        if self._waiting:  # for the database's answer: these states are written with the next ones
            self._waiting = False
            return
        states = [
            MachineState(collection=collection, machine=machine, stamp=self._ros.now(), msg=_text(message))
            for collection, machine, take in self._topics
            for message in take()
        ]
        if states:
            request = WriteMachineStates.Request(states=states)
            sent = self._ros.call_then(WriteMachineStates, "/tms/db/write_machine_states", request, self._written)
            self._waiting = sent is not None

    def _written(self, _: WriteMachineStates.Response) -> None:
        self._waiting = False


def _pose_topic(border: Border) -> tuple[type[Message], str] | None:
    """Type and name of the topic that tells where the base is; None if there is none."""
    if border.pose:
        return POSES[border.sources["pose"].message], border.pose
    return (Odometry, border.odom) if border.odom else None


def _text(message: Any) -> str:
    """A state as the C++ system keeps it, which has poses as odometry."""
    if isinstance(message, PoseStamped):
        message = Odometry(header=message.header, pose=PoseWithCovariance(pose=pose_of(message)))
    return json.dumps(plain(message))


def plain(message: Any) -> Any:
    """A ROS message as dictionaries and lists."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: plain(getattr(message, name)) for name in message.get_fields_and_field_types()}
    if isinstance(message, (bool, int, float, str)):
        return message
    return [plain(one) for one in (message.tolist() if hasattr(message, "tolist") else message)]
