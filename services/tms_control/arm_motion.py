"""A goal of a trajectory controller: what it asks of the joints, and how it may end. Pure logic.

The tolerances are those of control_msgs/FollowJointTrajectory: of a goal's own, 0 means the default, and below 0 that
there is none.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from tms_control.reference_trajectory import ReferenceTrajectory
from tms_control.verdict import Verdict

TOLERANCE = 0.03  # rad, at the end of a goal
STOPPED = 0.01  # rad/s, at the end of a goal
GOAL_TIME = 60.0  # s after the end in which the arm may still arrive, as in OPERA's configuration
PATH_VIOLATED, GOAL_VIOLATED = -4, -5  # control_msgs result codes


@dataclass(frozen=True)
class Tolerances:
    """How far joints may be off, by name; a joint that is missing here has the default."""

    path: Mapping[str, float] = field(default_factory=dict)  # rad, while it moves; by default there is none
    goal: Mapping[str, float] = field(default_factory=dict)  # rad
    stopped: Mapping[str, float] = field(default_factory=dict)  # rad/s, at the end
    seconds: float = 0.0  # s after the end; 0: the default


@dataclass
class ArmMotion:
    """One goal under way."""

    reference: ReferenceTrajectory
    tolerances: Tolerances
    begun: float  # s of the machine, when the reference begins; joints follow a dead time ahead of it
    verdict: Verdict | None = None

    @property
    def goal_time(self) -> float:
        """How long after its end the arm may still arrive [s]; infinite without a limit."""
        seconds = self.tolerances.seconds
        return GOAL_TIME if seconds == 0.0 else seconds if seconds > 0.0 else float("inf")


def limit(tolerances: Mapping[str, float], joint: str, default: float) -> float:
    """The tolerance of a joint."""
    wanted = tolerances.get(joint, 0.0)
    return default if wanted == 0.0 else wanted if wanted > 0.0 else float("inf")
