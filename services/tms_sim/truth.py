"""The true motion of a stand-in on a topic of its own, /<machine>/sim/truth, which no fault changes. For drills.

The time passes in the steps of telemetry.py, 0.04 s unless the process was held up, and each step is published.
"""

import math

from sensor_msgs.msg import JointState

from tms_config.clock import unix_ns
from tms_ros.node import Ros
from tms_sim.machine import StandIn
from tms_sim.sources import time_of

KEPT = 250  # messages, 10 s, for a reader that is held up for a moment: the truth has no gaps
TRACKS = ["x", "y", "yaw"]  # m, m, rad in `map`


class Truth:
    """Positions and velocities in the machine's time. Costs nothing without a subscriber."""

    def __init__(self, ros: Ros, name: str, machine: StandIn) -> None:
        self._machine = machine
        self._publisher = ros.publisher(JointState, f"/{name}/sim/truth", KEPT)
        self._message = JointState(name=[*machine.arm.joints, *(TRACKS if machine.base else [])])

    def publish(self) -> None:
        """Publish the motion; called after every step."""
        if not self._publisher.get_subscription_count():
            return
        arm, base, message = self._machine.arm, self._machine.base, self._message
        positions, velocities = arm.positions, arm.velocities
        if base is not None:
            positions += [base.x, base.y, base.yaw]
            velocities += [base.v * math.cos(base.yaw) + base.leak, base.v * math.sin(base.yaw), base.w]
        message.header.stamp = time_of(unix_ns())
        message.position, message.velocity = positions, velocities
        self._publisher.publish(message)
