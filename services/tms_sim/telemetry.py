"""What a stand-in tells: joint states, odometry and frames, all from one timer; a timer costs more than its work.

25 Hz is the rate of the simulator's excavators. Velocities are those of the machine, also when its time runs faster
than real time. Messages are made once and changed in place, since making them is what a process spends most on.
"""

import math
import time
from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from tms_core.app import App
from tms_sim.base import Base
from tms_sim.frames import Chain, Frame, about
from tms_sim.machine import StandIn

PERIOD = 0.04  # s
TF_EVERY = 2  # periods a set of frames while something moves
TF_STILL = 10  # and while nothing does: every listener pays for each
LAG = 12  # periods at most that are caught up after the process was held up


class Telemetry:
    """Lets the machine's time pass, in whole periods so that the same goals give the same motion, and tells."""

    def __init__(self, app: App, machine: StandIn, name: str) -> None:
        border, model, ros = app.site.border(name), app.site.model_of(name), app.ros
        self._ros, self._machine, self._speed = ros, machine, app.site.file.sim.speed
        self._chain = Chain(model, border)
        names = [border.joints.get(joint, joint) for joint in machine.arm.joints]
        self._state = JointState(name=names, effort=[0.0] * len(names))
        self._states = ros.publisher(JointState, f"/{name}/{border.joint_states}") if border.joint_states else None
        self._odom = Odometry(child_frame_id=f"{border.frame_prefix}base_link")
        self._odom.header.frame_id = f"{border.frame_prefix}odom"
        self._odoms = ros.publisher(Odometry, f"/{name}/{border.odom}") if border.odom else None
        self._tf = ros.publisher(TFMessage, "/tf")
        self._origin = (machine.base.x, machine.base.y, machine.base.yaw) if machine.base else app.site.start_of(name)
        self._frames: TFMessage = None
        self._told: Any = None  # place and joints of the frames
        self._begun, self._periods, self._ticks = time.monotonic(), 0, 0

    def tick(self) -> None:
        """One timer call."""
        due = round((time.monotonic() - self._begun) / PERIOD) - self._periods
        self._periods += due
        for _ in range(min(due, LAG)):
            self._machine.step(PERIOD * self._speed)
        stamp = self._ros.now()
        if self._states is not None:
            self._states.publish(self._joints(stamp))
        if self._odoms is not None and self._machine.base is not None:
            self._odoms.publish(self._odometry(stamp, self._machine.base))
        self._ticks += 1
        if self._ticks % TF_EVERY == 0:
            self._tell_frames(stamp)

    def _joints(self, stamp: Any) -> Any:
        arm, state = self._machine.arm, self._state
        state.header.stamp = stamp
        velocities = list(arm.velocities)
        velocities[0] += self._machine.creeping
        state.position, state.velocity = arm.reading(), velocities
        return state

    def _odometry(self, stamp: Any, base: Base) -> Any:
        """Position since the start, in a frame of its own, as encoders count it."""
        odom = self._odom
        x0, y0, yaw0 = self._origin
        dx, dy, c, s = base.x - x0, base.y - y0, math.cos(yaw0), math.sin(yaw0)
        odom.header.stamp = stamp
        pose, twist = odom.pose.pose, odom.twist.twist
        pose.position.x, pose.position.y = c * dx + s * dy, c * dy - s * dx
        _, _, pose.orientation.z, pose.orientation.w = about("z", base.yaw - yaw0)
        twist.linear.x, twist.angular.z = base.v + self._machine.creeping, base.w
        return odom

    def _tell_frames(self, stamp: Any) -> None:
        machine, base = self._machine, self._machine.base
        place = (base.x, base.y, base.yaw) if base else self._origin
        now = (place, tuple(machine.arm.positions))
        if now == self._told and self._ticks % TF_STILL:
            return
        if now != self._told:
            frames = self._chain.frames(place, dict(zip(machine.arm.joints, machine.arm.positions, strict=True)))
            self._frames, self._told = TFMessage(transforms=[_transform(frame) for frame in frames]), now
        for transform in self._frames.transforms:
            transform.header.stamp = stamp
        self._tf.publish(self._frames)


def _transform(frame: Frame) -> TransformStamped:
    x, y, z = frame.xyz
    qx, qy, qz, qw = frame.turn
    found = TransformStamped(child_frame_id=frame.child)
    found.header.frame_id = frame.parent
    found.transform = Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw))
    return found
