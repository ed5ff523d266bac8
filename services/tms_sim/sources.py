"""The topics that report a machine's motion, as its border has them.

Each topic has one message, which is changed in place: making messages would be most of the process's load.
"""

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Pose, PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

from tms_config.models import Border, Source
from tms_machine.frames import MAP
from tms_machine.geometry import about
from tms_ros.node import Ros
from tms_sim.sensor_model import SECOND, Reading
from tms_sim.soil import turn_of

Fill = Callable[[Any, Reading], None]  # fills a message from a reading


class Topic:
    """One source of the border."""

    def __init__(self, ros: Ros, name: str, message: Any, fill: Fill, source: Source, begun: int) -> None:
        """`begun` [ns, utc] is when the machine's own time was 0."""
        self.publisher = ros.publisher(type(message), name)
        self._message, self._fill, self._source, self._begun = message, fill, source, begun

    def due(self, tick: int, period: float) -> bool:
        """Whether to publish at this tick, with a tick every `period` [s]: at most as often as declared."""
        share = period / self._source.period
        return share >= 1 or int(tick * share + 1e-6) != int((tick - 1) * share + 1e-6)

    def publish(self, reading: Reading) -> None:
        """Publish a reading."""
        self._message.header.stamp = self._stamp(reading.stamp)
        self._fill(self._message, reading)
        self.publisher.publish(self._message)

    def _stamp(self, stamp: int) -> Time:
        if self._source.stamps == "none":
            return Time()
        return time_of(stamp - self._begun if self._source.stamps == "since_start" else stamp)


def time_of(nanoseconds: int) -> Time:
    """A time as a ROS message."""
    seconds, rest = divmod(nanoseconds, SECOND)
    return Time(sec=seconds, nanosec=rest)


def topics(
    ros: Ros, machine: str, border: Border, joints: Sequence[str], origin: tuple[float, float, float],
    muted: Callable[[], Collection[str]], begun: int,
) -> list[Topic]:  # fmt: skip
    """All sources of a border that a stand-in has. `muted` returns the joints that are left out now."""
    made: dict[str, tuple[Any, Fill]] = {"joint_states": (JointState(), _joint_states(border, joints, muted))}
    odom = Odometry(child_frame_id=f"{border.frame_prefix}base_link")
    odom.header.frame_id = f"{border.frame_prefix}odom"
    made["odom"] = (odom, lambda message, reading: _odometry(message, reading, origin))
    if border.pose:
        stamped = border.sources["pose"].message == "PoseStamped"
        pose: Any = PoseStamped() if stamped else Odometry(child_frame_id=f"{border.frame_prefix}base_link")
        pose.header.frame_id = MAP
        made["pose"] = (pose, _pose_stamped if stamped else _global_pose)
    return [
        Topic(ros, f"/{machine}/{getattr(border, key)}", *made[key], source, begun)
        for key, source in border.sources.items() if key in made
    ]  # fmt: skip


def _joint_states(border: Border, joints: Sequence[str], muted: Callable[[], Collection[str]]) -> Fill:
    names = [border.joints.get(joint, joint) for joint in joints]

    def fill(state: JointState, reading: Reading) -> None:
        silent = muted()
        received = [i for i, joint in enumerate(joints) if joint not in silent]
        state.name, state.effort = [names[i] for i in received], [0.0] * len(received)
        state.position = [reading.positions[i] for i in received]
        state.velocity = [reading.velocities[i] for i in received]

    return fill


def _odometry(odom: Odometry, reading: Reading, origin: tuple[float, float, float]) -> None:
    """Fill in the position since the start, in a frame of its own, as encoders measure it."""
    (x, y, yaw), (x0, y0, yaw0) = reading.place, origin
    dx, dy, c, s = x - x0, y - y0, math.cos(yaw0), math.sin(yaw0)
    _place(odom.pose.pose, c * dx + s * dy, c * dy - s * dx, yaw - yaw0)
    odom.twist.twist.linear.x, odom.twist.twist.angular.z = reading.speeds


def _global_pose(odom: Odometry, reading: Reading) -> None:
    """Fill in the pose without velocities, as in the simulator."""
    _stand(odom.pose.pose, reading)


def _pose_stamped(pose: PoseStamped, reading: Reading) -> None:
    _stand(pose.pose, reading)


def _stand(pose: Pose, reading: Reading) -> None:
    """Fill in a place on the ground."""
    x, y, yaw = reading.place
    pose.position.x, pose.position.y, pose.position.z = x, y, reading.stands.height
    q = pose.orientation
    q.x, q.y, q.z, q.w = turn_of(yaw, reading.stands)


def _place(pose: Pose, x: float, y: float, yaw: float) -> None:
    pose.position.x, pose.position.y = x, y
    _, _, pose.orientation.z, pose.orientation.w = about("z", yaw)
