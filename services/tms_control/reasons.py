"""Why a motion controller refuses a goal, or ends it before it is reached."""

from tms_reason.quantities import Metres, Moments, Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import INSPECT


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
# fmt: on
