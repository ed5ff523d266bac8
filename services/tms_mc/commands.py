"""The topics that move the joints of a machine."""

from collections.abc import Mapping
from typing import Any

from com3_msgs.msg import JointCmd
from std_msgs.msg import Float64

from tms_config.models import Border
from tms_ros.node import Ros

POSITION = 0  # com3_msgs/JointCmd.control_type


class JointCommands:
    """Sends angles [rad]: all in one message where the machine takes that, else each on a topic of its own.

    OperaSim-PhysX delays only what comes in one message, and only for the joints of the latest one: all are in each.
    """

    def __init__(self, ros: Ros, machine: str, border: Border) -> None:
        self._names = border.joints
        self._single: dict[str, Any] = {}
        self._joint_cmd = ros.publisher(JointCmd, f"/{machine}/{border.joint_cmd}") if border.joint_cmd else None
        if self._joint_cmd is None:
            topics = border.joint_angles
            self._single = {joint: ros.publisher(Float64, f"/{machine}/{topics[joint]}") for joint in topics}

    def reaches(self, joint: str) -> bool:
        """Whether there is a topic that moves a joint."""
        return self._joint_cmd is not None or joint in self._single

    def send(self, angles: Mapping[str, float]) -> None:
        """Command angles, by joint of the model."""
        if self._joint_cmd is not None:
            names = [self._names.get(joint, joint) for joint in angles]
            self._joint_cmd.publish(JointCmd(joint_name=names, control_type=POSITION, position=list(angles.values())))
            return
        for joint, angle in angles.items():
            self._single[joint].publish(Float64(data=angle))
