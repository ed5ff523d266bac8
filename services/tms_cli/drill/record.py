"""The record of one machine in one trial: its true motion and our messages about it. All times are s since 1970."""

import math
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tms_config.models import Still

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time
    from sensor_msgs.msg import JointState


@dataclass(frozen=True)
class MotionSample:
    """The true motion at one moment."""

    at: float
    share: float  # velocity / limit of standing, the highest of all parts
    joints: Mapping[str, float]  # rad
    place: tuple[float, float]  # m


@dataclass(frozen=True)
class Receipt:
    """A tms_msg_rc/StopReceipt, and the time of its arrival."""

    begun: float
    seconds: float
    confirmed: bool
    cause: str
    detail: str
    came: float

    @property
    def at(self) -> float:
        """The time from which the receipt claims that the machine stands."""
        return self.begun + self.seconds


@dataclass
class Goal:
    """A goal at one of the machine's own action servers."""

    began: float
    ended: float | None = None
    arrived: bool = False  # it ended by itself


@dataclass(frozen=True)
class ReportedState:
    """The used fields of a tms_msg_rc/MachineState."""

    at: float
    latch: str
    hold: str


@dataclass
class TrialRecording:
    """The executor thread fills it; the verdict uses a copy."""

    truth: list[MotionSample] = field(default_factory=list)
    receipts: list[Receipt] = field(default_factory=list)
    goals: dict[bytes, Goal] = field(default_factory=dict)
    states: list[ReportedState] = field(default_factory=list)
    commands: list[float] = field(default_factory=list)  # times of orders to stop, when they reach the machine
    releases: list[float] = field(default_factory=list)  # times at which its emergency stop was released

    def since(self, at: float) -> "TrialRecording":
        """The part after a moment, with the stops and goals that were under way then, and the last state before it."""
        return TrialRecording(
            self.truth[bisect_left(self.truth, at, key=lambda one: one.at) :],
            [one for one in self.receipts if one.at >= at],
            {key: one for key, one in self.goals.items() if one.ended is None or one.ended >= at},
            [*[one for one in self.states if one.at < at][-1:], *[one for one in self.states if one.at >= at]],
            [one for one in self.commands if one >= at],
            [one for one in self.releases if one >= at],
        )

    def close_goals(self, at: float) -> None:
        """End all open goals."""
        for goal in self.goals.values():
            goal.ended = at if goal.ended is None else goal.ended

    def goal_after(self, at: float) -> float:
        """The begin of the first goal after a moment; infinite if there is none."""
        return min((goal.began for goal in self.goals.values() if goal.began > at), default=math.inf)


def sample_of(message: "JointState", still: Still) -> MotionSample:
    """A sample from the stand-in's sensor_msgs/JointState: joints, then x, y and yaw of the tracks."""
    places = dict(zip(message.name, message.position, strict=True))
    speeds = dict(zip(message.name, message.velocity, strict=True))
    x, y, yaw = (places.pop(name, 0.0) for name in ("x", "y", "yaw"))
    way = math.hypot(speeds.pop("x", 0.0), speeds.pop("y", 0.0)) / still.linear
    turn = abs(speeds.pop("yaw", 0.0)) / still.angular
    joints = max((abs(speed) for speed in speeds.values()), default=0.0) / still.velocity
    return MotionSample(time_of(message.header.stamp), max(joints, way, turn), {**places, "heading": yaw}, (x, y))


def time_of(stamp: "Time") -> float:
    """Seconds since 1970."""
    return float(stamp.sec + stamp.nanosec * 1e-9)
