"""Why a motion controller refuses a goal, or ends it before it is reached."""

from tms_reason.quantities import Metres, Moments, Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import INSPECT, Remedy

OTHER_GOAL = Remedy("goal", "", "Choose another goal, or clear the way first")


# fmt: off
# a trajectory that cannot be followed
class OtherJoints(Reason, text="the trajectory is for the joints {given}, the machine has {known}"):
    given: tuple[str, ...]; known: tuple[str, ...]
class TrajectoryEmpty(Reason, text="the trajectory is empty"): pass
class PointUnfit(Reason,
    text="point {number} of the trajectory does not give a position, or a velocity, for each joint"): number: int
class PointNotFinite(Reason, text="point {number} of the trajectory holds a value that is not a number"): number: int
class PointTooEarly(Reason, text="point {number} of the trajectory, at {time}, is not after the one before it"):
    number: int; time: Moments

# the end of a goal
class ShortOfGoal(Reason, text="{joint} is {off} off its goal {late} after its time", action=INSPECT):
    joint: str; off: Radians; late: Seconds
class OffReference(Reason, text="{joint} is {off} off its path: {allowed} is allowed"):
    joint: str; off: Radians; allowed: Radians
class TakenOver(Reason, text="a newer goal has taken over"): pass

# tracks
class Silenced(Reason, text="the gateway has stopped the machine"): pass
class NoProgress(Reason, text="no progress within {seconds}", action=INSPECT): seconds: Seconds
class PosesStopped(Reason, text="no pose of the machine for {seconds}", action=INSPECT): seconds: Seconds
class LeftPath(Reason, text="{beside} and {turned} off the path"): beside: Metres; turned: Radians
class ShortOfPose(Reason, text="{away} and {turned} off the goal after {attempts} attempts", action=INSPECT):
    away: Metres; turned: Radians; attempts: int

# what stands on the ground
class MachineThere(Reason, text="{machine}"): machine: str
class BlockedArea(Reason, text="the blocked area '{area}'"): area: str
class InTheWay(Reason, text="at ({x}, {y}), {away} along its way"): x: Metres; y: Metres; away: Metres
class StandsIn(Reason, text="the machine stands in {by}", action=INSPECT): by: Reason
class GoalTaken(Reason, text="the goal is {gap} from {by}: {needed} is needed", action=OTHER_GOAL):
    by: Reason; gap: Metres; needed: Metres
class NoWayAround(Reason, text="{by} is in the way {why}; no way around was found", action=OTHER_GOAL):
    by: Reason; why: Reason
class PathBlocked(Reason, text="{by} has come into the way: {why}", action=INSPECT): by: Reason; why: Reason
# fmt: on
