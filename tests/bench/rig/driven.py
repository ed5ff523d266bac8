"""Machines with real gateways: each goal of their subtasks is one of ten seconds at the machine, which stands still.

python driven.py NAME SUBTASK,... MACHINE...

Prints `ready`. Machines and subtasks are in one process: on a site they are on PCs of their own.
"""

from __future__ import annotations

import sys
import threading
import time
from array import array
from collections.abc import Callable
from typing import Any

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from tms_msg_ts.action import LeafNodeBase
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_config.config import load_site
from tms_config.models import Border
from tms_machine.border import motions
from tms_machine.frames import MAP
from tms_machine.permit import Permit
from tms_reason import wire
from tms_ros.client import Call
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.server import Goal
from tms_runtime import environment
from tms_runtime.fence import derived
from tms_runtime.priority import come_first, threads
from tms_runtime.pulse import Pulse
from tms_runtime.run import OF_A_MACHINE

WORK = 10  # s that a motion takes
POSE = {"swing_joint": 0.0, "boom_joint": -0.8, "arm_joint": 1.8, "bucket_joint": 0.5, "bucket_end_joint": 0.0}  # rad
STATE_PERIOD = 0.1  # s between two states of a machine
AGAIN = 0.5  # s between tries of a goal that was refused
APART = 20.0  # m between two machines
LIMIT = 60.0  # s for a motion to end
HURRY = -10  # nice value: machines have PCs of their own


class Machine:
    """One of them."""

    def __init__(self, ros: Ros, pulse: Pulse, border: Border, x: float, name: str, subtasks: list[str]) -> None:
        self._ros = ros
        self._place = TransformStamped(child_frame_id=border.base_frame)
        self._place.header.frame_id, self._place.transform.translation.x = MAP, x
        self._joints = ros.publisher(JointState, f"/{name}/{border.joint_states}")
        self._odometry = ros.publisher(Odometry, f"/{name}/{border.odom}")
        self._state = JointState(name=list(POSE), position=POSE.values(), velocity=[0.0] * len(POSE))
        for motion in motions(border):
            ros.serve(motion.type, f"/{name}/{getattr(border, motion.field)}", _standing(motion.type))
        self._gateway = ros.peer(FollowJointTrajectory, f"/{name}/rc/follow_joint_trajectory")
        for subtask in subtasks:
            self._serve(ros, Permit(ros, pulse, name, subtask), f"/{name}/{subtask}")

    def tell(self) -> TransformStamped:
        """Publish its state; where it stands."""
        self._state.header.stamp = self._place.header.stamp = self._ros.now()
        self._joints.publish(self._state)
        self._odometry.publish(Odometry(header=self._state.header))
        return self._place

    def _serve(self, ros: Ros, permit: Permit, action: str) -> None:
        def work(goal: Goal) -> Ended:
            permit.hold(goal.uuid)
            try:
                return self._move(goal)
            finally:
                permit.drop()

        ros.serve(LeafNodeBase, action, work)

    def _move(self, goal: Goal) -> Ended:
        angles = array("d", POSE.values())
        point = JointTrajectoryPoint(positions=angles, time_from_start=Duration(sec=WORK, nanosec=0))
        motion = FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=list(POSE), points=[point]))
        deadline = time.monotonic() + LIMIT
        call = self._send(goal, motion)
        while call.outcome is Outcome.REJECTED and time.monotonic() < deadline and not goal.cancelled.wait(AGAIN):
            call = self._send(goal, motion)  # not everybody had found everybody yet
        if call.outcome is Outcome.SUCCEEDED:
            return Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)
        if (why := wire.of(getattr(call.result, "error_string", ""))) is not None:
            goal.say(why)
        return Outcome.CANCELED if goal.cancelled.is_set() else Outcome.ABORTED, LeafNodeBase.Result()

    def _send(self, goal: Goal, motion: FollowJointTrajectory.Goal) -> Call:
        """Send the motion and wait for its end."""
        call = self._gateway.send(motion, goal_id=derived(goal.uuid))
        goal.on_cancel = lambda: self._gateway.cancel(call)
        call.wait_for(lambda: call.outcome is not None, LIMIT)
        return call


def _standing(kind: Any) -> Callable[[Goal], Ended]:
    def stand(goal: Goal) -> Ended:
        cancelled = goal.cancelled.wait(WORK)
        return Outcome.CANCELED if cancelled else Outcome.SUCCEEDED, kind.Result()

    return stand


def main(name: str, subtasks: str, *names: str) -> None:
    site = load_site()
    environment.enter(site)
    ros = Ros(f"driven_{name}")
    pulse = Pulse(ros)
    places = ros.publisher(TFMessage, "/tf", depth=100)
    machines = [
        Machine(ros, pulse, site.border(machine), APART * int(machine[1:]), machine, subtasks.split(","))
        for machine in names
    ]

    def news() -> None:
        places.publish(TFMessage(transforms=[machine.tell() for machine in machines]))

    ros.every(STATE_PERIOD, news)
    _, realtime = OF_A_MACHINE
    come_first(HURRY, threads(), realtime)
    print("ready", flush=True)
    threading.Event().wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
