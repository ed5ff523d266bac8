"""Why a machine cannot do, or must not do, what a goal asks, and what it does meanwhile."""

from tms_reason.quantities import Metres, Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, EDIT_TASK, INSPECT, PROCESSES, RECORDS, Remedy

DECLARE_FORM = Remedy("edit_config", "", "Say it for {machine} under peers: or forms: of the site file")


# fmt: off
# a goal that is refused
class Busy(Reason, text="{process} is still at its last goal"): process: str
class NoDatabase(Reason, text="{process} did not answer", action=PROCESSES): process: str
class OneSubtask(Reason, text="{file}: {count} subtasks in it, there must be one"): file: str; count: int
class InputsNotTaken(Reason, text="the subtask takes no {inputs}", action=EDIT_TASK): inputs: tuple[str, ...]
class FormUnknown(Reason, text="{node} does not tell which form of {definition} it speaks",
    action=DECLARE_FORM): node: str; definition: str; machine: str
class FormContradicted(Reason, text="{node} speaks {definition} as {told}, and {declared} is expected for {machine}",
    action=DECLARE_FORM): node: str; definition: str; told: str; declared: str; machine: str
class BorderLost(Reason, text="{process}, which could have passed a cancel on, was lost", action=PROCESSES):
    process: str
class FieldMissing(Reason, text="field '{field}' is missing", action=RECORDS): field: str
class ListsDiffer(Reason, text="the lists differ in length: {lengths}", action=RECORDS): lengths: str
class PathEmpty(Reason, text="the path is empty", action=RECORDS): pass
class NoUnitLength(Reason, text="qx, qy, qz, qw have length {length}, an orientation has 1", action=RECORDS):
    length: str
class MoreThanOneTurn(Reason, text="{degrees} deg is more than one turn", action=RECORDS): degrees: str
class OneWaypoint(Reason, text="there are {count} waypoints, there must be one", action=RECORDS): count: int
class NotHonoured(Reason, text="the planner can keep no {constraints}", action=RECORDS): constraints: tuple[str, ...]
class PathLeavesConstraint(Reason, text="the way would bring {joint} to {angle}, the record allows {low} to {high}",
    action=RECORDS): joint: str; angle: Radians; low: Radians; high: Radians
class NoPlan(Reason, text="no plan is stored in {records}", action=EDIT_TASK): records: tuple[str, ...]
class NoFlag(Reason, text="one of {flags} must be 1", action=RECORDS): flags: tuple[str, ...]
class BadRecord(Reason, text="record {record}: {problem}", action=RECORDS): record: str; problem: Reason
class NoSuchJoint(Reason, text="there is no joint '{joint}' (there are {joints})"): joint: str; joints: tuple[str, ...]
class NoCapability(Reason, text="{machine} has no {what}", action=EDIT_CONFIG,
    details="see borders: in configs/machines/{model}.yaml"): machine: str; what: str; model: str

# a goal that ended before it was done
class GoalTimeout(Reason, text="{machine} was not done after {limit}", code="TIMEOUT"): machine: str; limit: Seconds
class Aborted(Reason, text="{why}", details="{name} aborted the goal"): why: Reason; name: str
class Rejected(Reason, text="{why}", details="{name} rejected the goal"): why: Reason; name: str
class Canceled(Reason, text="{why}", details="{name} cancelled the goal"): why: Reason; name: str
class NoReason(Reason, text="no reason was given"): pass
class ErrorNumber(Reason, text="error {number}"): number: int
class Missed(Reason, text="waypoints {waypoints} were missed"): waypoints: tuple[int, ...]
class MissedWaypoints(Reason, text="{machine} did not reach waypoint {waypoints}"):
    machine: str; waypoints: tuple[Reason, ...]
class Waypoint(Reason, text="{number} ({x}, {y})"): number: int; x: Metres; y: Metres
class NotReached(Reason, text="{machine} says that it did not reach {angle}", details="{what}"):
    machine: str; angle: Radians; what: str
class BladeNotThere(Reason, text="{machine} says that its blade did not reach the angles"): machine: str
class NoJointState(Reason, text="no state of {joint} of {machine} was received within {limit}", action=PROCESSES,
    details="{topic}"): joint: str; machine: str; limit: Seconds; topic: str
class MotionNotEnded(Reason, text="{machine} did not end its motion", action=INSPECT): machine: str
class NotInMap(Reason, text="the pose is told in the frame '{frame}', not in 'map'", action=INSPECT, details="{topic}"):
    frame: str; topic: str
class WaitsForPerson(Reason, text="waits for a person: {question}"): question: str
class PersonSaysNo(Reason, text="a person has said no: {question}"): question: str
class WaitingFor(Reason, text="waiting for {process}", action=PROCESSES): process: str

# progress
class Driving(Reason, text="driving, {left} to go"): left: Metres
class DrivingThrough(Reason, text="driving, {left} and {poses} poses to go"): left: Metres; poses: int
class DrivingTo(Reason, text="driving to waypoint {waypoint} of 0 to {last}"): waypoint: int; last: int
class Turning(Reason, text="turning, {left} to go"): left: Radians
