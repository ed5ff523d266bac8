"""What is wrong with a goal, and what keeps a gateway from its work."""

from tms_reason.quantities import Moments, Number, Radians, RadiansPerSecond
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, ENABLE, INSPECT, PROCESSES, REARM, RETRY


# fmt: off
# what a goal asks
class JointTwice(Reason, text="a joint is named twice: {joints}"): joints: tuple[str, ...]
class NoPoints(Reason, text="the trajectory has no points"): pass
class WrongLength(Reason, text="there are {positions} positions for {joints} joints"): positions: int; joints: int
class NoNumber(Reason, text="this is not a number"): pass
class AtPoint(Reason, text="point {number}: {why}"): number: int; why: Reason
class AtPose(Reason, text="pose {number}: {why}"): number: int; why: Reason
class AtJoint(Reason, text="{joint}: {why}"): joint: str; why: Reason
class RestNoNumber(Reason, text="a velocity, acceleration or effort is not a number"): pass
class TimeNotAfter(Reason, text="its time {time} is not after the one before"): time: Moments
class TooFast(Reason, text="it would go {way} in {time}, its limit is {limit}"):
    way: Radians; time: Moments; limit: RadiansPerSecond
class AnglesOnly(Reason, text="a blade is moved to angles only"): pass
class NothingTurns(Reason, text="the model has no joint for {what}", action=EDIT_CONFIG): what: str
class NoPose(Reason, text="there is no pose in the goal"): pass
class BadQuaternion(Reason, text="its quaternion has the length {length}, not 1"): length: Number
class Escaped(Reason, text="{joint} has left its limits: {why}"): joint: str; why: Reason

# what the machine tells of itself
class StrangeType(Reason, text="{source} come as another type of message than the machine file says",
    action=EDIT_CONFIG, details="{node} publishes {topic} as {found}, which is no {wanted}"):
    source: Reason; node: str; topic: str; found: str; wanted: str

# notes on the disk
class StateNotKept(Reason, text="the note of its state cannot be written: make room on the disk of this PC",
    details="{problem}"): problem: str
class DriverNotKept(Reason, text="the note of who drives cannot be written: make room on the disk of this PC",
    details="{problem}"): problem: str
class NoteUnreadable(Reason, text="the note of how the machine was left cannot be read", action=INSPECT): pass

# areas
class AreasNotEnabled(Reason, text="no areas are enabled for this site", action=ENABLE): pass
class AreasUnreadable(Reason, text="its enabled areas cannot be read", action=ENABLE): pass
class AreasLate(Reason, text="its areas have not been looked at for {seconds}"): seconds: Moments
class IntrudersLate(Reason, text="nobody has looked for people for {seconds}"): seconds: Moments
class HardwareLate(Reason, text="nobody has looked at its hardware for {seconds}"): seconds: Moments
class AreasNotKept(Reason, text="the areas cannot be written: make room on the disk of this PC", details="{problem}"):
    problem: str
class TrapsMachine(Reason, text="{machine} moves where these areas would stop it: {why}", action=RETRY):
    machine: str; why: Reason
class AreaRequestBad(Reason, text="the request is incomplete or wrong: {why}"): why: Reason
class ParameterTwice(Reason, text="{name} is given twice"): name: str
class AreasOfOtherId(Reason, text="the areas are not those that were shown: their content is {found}, shown was {told}",
    action=ENABLE): told: str; found: str
class Unsigned(Reason, text="say who asks for this"): pass
class NothingToEscape(Reason, text="{machine} is where it may be, with its margin: it may move as ever"): machine: str
class EscapesAtRest(Reason, text="{machine} is let back in only once it stands, is armed and has no goal",
    action=REARM): machine: str
class GoalNotInMap(Reason, text="its poses are in the frame '{frame}', areas are in map"): frame: str

# its own life
class Rival(Reason, text="another gateway for {machine} runs ({where})", action=PROCESSES): machine: str; where: str
class LooksForRivals(Reason, text="looks for another gateway"): pass
