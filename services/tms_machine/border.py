"""The machine's own border: its motion actions, and the commands that stop it. No call here waits."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from action_msgs.srv import CancelGoal
from com3_msgs.action import SetDumpAngle, SetSwingAngle
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Twist
from nav2_msgs.action import FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose
from std_msgs.msg import Bool
from tms_msg_rp.action import TmsRpBulldozerBlade

from tms_config.clock import monotonic
from tms_config.models import Border
from tms_interfaces.generated import ActionType, Publisher
from tms_ros.node import Ros

CANCEL_LIMIT = 3.0  # s after which a server without an answer has lost a cancel
PRESS_LIVES = 1.5  # s; who presses in place of the gateway repeats it every 0.5 s
RELAYING = "if_motions"  # permit of `<machine>:if` while it passes goals for motions on
PLAN = "plan"  # topic of the navigation below /<machine>/: the way that it drives (nav_msgs/Path), as Nav2 tells it
RELEASE_LIMIT = 0.5  # s for a machine to take the release of its emergency stop: that is a message without an answer


@dataclass(frozen=True)
class MotionAction:
    """One kind of motion action that a machine may have."""

    field: str  # of the border's configuration
    served: str  # name below /<machine>/rc/
    type: ActionType[Any, Any, Any]

    @property
    def drives(self) -> bool:
        """Whether it moves the tracks."""
        return self.field.startswith(("navigate_", "follow_"))


MOTIONS = (
    MotionAction("trajectory", "follow_joint_trajectory", FollowJointTrajectory),
    MotionAction("navigate_to_pose", "navigate_to_pose", NavigateToPose),
    MotionAction("navigate_through_poses", "navigate_through_poses", NavigateThroughPoses),
    MotionAction("follow_waypoints", "follow_waypoints", FollowWaypoints),
    MotionAction("follow_path", "follow_path", FollowPath),
    MotionAction("set_dump_angle", "set_dump_angle", SetDumpAngle),
    MotionAction("set_swing_angle", "set_swing_angle", SetSwingAngle),
    MotionAction("set_bulldozer_blade", "set_bulldozer_blade", TmsRpBulldozerBlade),
)


def motions(border: Border) -> list[MotionAction]:
    """The motion actions that a machine has."""
    return [motion for motion in MOTIONS if getattr(border, motion.field)]


def stood_in(machine: str) -> str:
    """Latched topic of the host agent: when it last pressed `emg_stop` in place of a lost gateway."""
    return f"/{machine}/rc/stood_in"


def standby(machine: str) -> str:
    """Latched topic of the host agent: whether it commands the machine in place of its gateway."""
    return f"/{machine}/rc/standby"


def speed_limit(machine: str) -> str:
    """Latched topic of the gateway: how fast the tracks may go now [m/s], for what drives them; infinite: no limit."""
    return f"/{machine}/rc/speed_limit"


class Controls:
    """Direct access to a machine; only for the gateway and for the standby of a lost one."""

    def __init__(self, ros: Ros, machine: str, border: Border, keeps_emergency: bool = True) -> None:
        """`keeps_emergency`: a machine that is switched on later still receives the last `emg_stop`.

        Only for the gateway, which also releases it: an old `true` of another publisher would hold the machine. What
        another one says is latched, too, but for a moment: else nobody could hear both of them, and what was kept.
        """
        self._ros = ros
        self._cancels = [f"/{machine}/{getattr(border, m.field)}/_action/cancel_goal" for m in motions(border)]
        for service in self._cancels:
            ros.prepare(CancelGoal, service)
        # By service: when the last cancel was sent, and how to forget it. Changed on the executor thread only.
        self._unanswered: dict[str, tuple[float, Callable[[], None]]] = {}
        self._released = float("-inf")  # s, monotonic
        self._cmd_vel = ros.publisher(Twist, f"/{machine}/{border.cmd_vel}", 1) if border.cmd_vel else None
        self._emg_stop: Publisher[Bool] | None = None
        if border.emg_stop:
            lives = 0.0 if keeps_emergency else PRESS_LIVES
            self._emg_stop = ros.publisher(Bool, f"/{machine}/{border.emg_stop}", 1, latched=True, lives=lives)

    def cancel_everything(self) -> None:
        """Cancel the goals of all clients, by requests with zero id."""
        self._ros.on_executor(self._cancel)

    def _cancel(self) -> None:
        """Send every cancel, then look which servers are there: at a large site that takes as long as all the rest."""
        asked = CancelGoal.Request()
        sent = [self._ros.call_now(CancelGoal, one, asked, partial(self._taken, one)) for one in self._cancels]
        os.sched_yield()  # to this PC's other gateways, which have the same priority: all machines may be stopped now
        for service, forget in zip(self._cancels, sent, strict=True):
            if service in self._unanswered:  # servers take requests in order: the next answer stands for both
                self._unanswered.pop(service)[1]()
            if self._ros.has_service(CancelGoal, service):
                self._unanswered[service] = monotonic(), forget
            else:
                forget()

    def _taken(self, service: str, _answer: CancelGoal.Response) -> None:
        self._unanswered.pop(service, None)

    def settling(self) -> bool:
        """Whether a busy machine may still have commands of a stop before it: a goal that is sent now could be lost.

        A cancel that comes after the goal ends it, and a goal that comes before the release is refused.
        """
        now, sent = monotonic(), [at for at, _ in list(self._unanswered.values())]
        return now - self._released < RELEASE_LIMIT or any(now - at < CANCEL_LIMIT for at in sent)

    def zero(self) -> None:
        """Command zero velocity, where the machine takes velocities."""
        if self._cmd_vel is not None:
            self._cmd_vel.publish(Twist())

    def emergency(self, on: bool) -> None:
        """Set or clear the machine's own stop, where it has one."""
        if self._emg_stop is not None:
            self._emg_stop.publish(Bool(data=on))
            self._released = float("-inf") if on else monotonic()

    def reachable(self) -> bool:
        """Whether a cancel would reach every action server of the machine now."""
        return all(self._ros.has_service(CancelGoal, service) for service in self._cancels)
