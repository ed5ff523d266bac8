"""The topics that move the joints of a machine without controllers of its own."""

from collections.abc import Mapping
from typing import Any

from com3_msgs.msg import JointCmd
from std_msgs.msg import Float64

from tms_config.models import Border
from tms_ros.node import Ros

POSITION = 0  # com3_msgs/JointCmd.control_type


class JointCommands:
    """Sends angles [rad], by joint of the model: all in one message, or each on a topic of its own.

    OperaSim-PhysX delays only what comes in one message, and only for the joints of the latest one: so all are in each.
    The topics of single joints act at once there.
    """

    def __init__(self, ros: Ros, machine: str, border: Border, single: bool = False) -> None:
        """`single`: on topics of single joints where the machine has both."""
        self._names, topics = border.joints, border.joint_angles
        together = border.joint_cmd is not None and not (single and topics)
        self._together = ros.publisher(JointCmd, f"/{machine}/{border.joint_cmd}") if together else None
        self._single: dict[str, Any] = {}
        if not together:
            self._single = {joint: ros.publisher(Float64, f"/{machine}/{topics[joint]}") for joint in topics}

    def reaches(self, joint: str) -> bool:
        """Whether there is a topic that moves a joint."""
        return self._together is not None or joint in self._single

    def send(self, angles: Mapping[str, float]) -> None:
        """Command angles."""
        if self._together is not None:
            names = [self._names.get(joint, joint) for joint in angles]
            self._together.publish(JointCmd(joint_name=names, control_type=POSITION, position=list(angles.values())))
            return
        for joint in angles.keys() & self._single.keys():
            self._single[joint].publish(Float64(data=angles[joint]))
