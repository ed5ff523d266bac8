"""Why a motion controller ends a goal before it is reached."""

from tms_reason.quantities import Metres, Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import INSPECT


# fmt: off
class Silenced(Reason, text="the gateway has stopped the machine"): pass
class NoProgress(Reason, text="no progress within {seconds}", action=INSPECT): seconds: Seconds
class PosesStopped(Reason, text="no pose of the machine for {seconds}", action=INSPECT): seconds: Seconds
class LeftPath(Reason, text="{beside} and {turned} off the path"): beside: Metres; turned: Radians
class ShortOfPose(Reason, text="{away} and {turned} off the goal after {attempts} attempts", action=INSPECT):
    away: Metres; turned: Radians; attempts: int
# fmt: on
