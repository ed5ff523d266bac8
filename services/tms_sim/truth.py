"""The true motion of a stand-in on a way of its own, /<machine>/sim/truth, which no fault changes. For drills."""

import math
import time
from collections.abc import Callable
from typing import Any

from sensor_msgs.msg import JointState

from tms_core.ros import Ros
from tms_sim.machine import StandIn
from tms_sim.sources import time_of

PERIOD = 1 / 60  # s
KEPT = 180  # messages for a reader that is held up for a moment: the truth has no gaps
TRACKS = ["x", "y", "yaw"]  # m, m, rad in `map`


class Truth:
    """Positions and velocities in the machine's time. Costs nothing while nobody listens."""

    def __init__(self, ros: Ros, name: str, machine: StandIn, advance: Callable[[], None]) -> None:
        """`advance` lets the machine's time catch up."""
        self._ros, self._machine, self._advance = ros, machine, advance
        self._publisher = ros.publisher(JointState, f"/{name}/sim/truth", KEPT)
        self._message = JointState(name=[*machine.arm.joints, *(TRACKS if machine.base else [])])
        self._timer: Any = None

    def look(self) -> None:
        """Begin or end to tell, on the executor thread."""
        heard = self._publisher.get_subscription_count() > 0
        if heard and self._timer is None:
            self._timer = self._ros.every(PERIOD, self._tell)
        elif not heard and self._timer is not None:
            self._ros.node.destroy_timer(self._timer)
            self._timer = None

    def _tell(self) -> None:
        self._advance()
        arm, base, message = self._machine.arm, self._machine.base, self._message
        positions, velocities = arm.positions, arm.velocities
        if base is not None:
            positions += [base.x, base.y, base.yaw]
            velocities += [base.v * math.cos(base.yaw) + base.leak, base.v * math.sin(base.yaw), base.w]
        message.header.stamp = time_of(time.time_ns())
        message.position, message.velocity = positions, velocities
        self._publisher.publish(message)
