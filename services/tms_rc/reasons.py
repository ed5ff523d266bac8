"""Why a gateway lets no goal through, why it stops its machine, and why a stop is not proven."""

from tms_reason.quantities import Moments, Number, Radians, RadiansPerSecond, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import CANCEL, EDIT_CONFIG, INSPECT, PROCESSES, REARM, RELEASE_STOP, RETRY, STATUS


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
class NothingTurns(Reason, text="the model has no joint for {what}", action=EDIT_CONFIG): what: str
class NoPose(Reason, text="there is no pose in the goal"): pass
class BadQuaternion(Reason, text="its quaternion has the length {length}, not 1"): length: Number
class Escaped(Reason, text="{joint} has left its limits: {why}"): joint: str; why: Reason

# who stands behind a goal
class HeldByAnother(Reason, text="the machine is held by a run"): pass
class NoScheduler(Reason, text="no scheduler stands behind its run"): pass
class OldRun(Reason, text="it is a goal of an abandoned run",
    details="fencing number {number}, the present run has {now}"):
    number: int; now: int
class NoPlanner(Reason, text="the planner does not stand behind it"): pass
class NoSubtask(Reason, text="the subtask does not stand behind it"): pass
class StillMoved(Reason, text="{machine} is still moved by another goal"): machine: str
class NotReady(Reason, text="not ready: {why}"): why: Reason
class StopUnderWay(Reason, text="its last stop is still being proven"): pass
class Recovering(Reason, text="after its start the gateway still proves that the machine stands"): pass
class Held(Reason, text="held ({cause}): only a new goal of the same run may move it"): cause: Reason

# stops, and their causes
class Cancelled(Reason, text="cancelled"): pass
class SchedulerLost(Reason, text="the scheduler was lost during a run"): pass
class ThenSchedulerLost(Reason, text="{cause}, then the scheduler was lost"): cause: Reason
class ProcessesLost(Reason, text="{processes} was lost during its goal"): processes: tuple[str, ...]
class LeftStandStill(Reason, text="it left stand-still without a goal of its own"): pass
class NotSeenToStand(Reason, text="{cause}: not seen to stand ({detail})", action=REARM):
    cause: Reason; detail: Reason; machine: str
class PressedByOthers(Reason, text="the machine's emergency stop was pressed by somebody else"): pass
class NoGoalAnswer(Reason, text="the controller of {machine} did not answer a goal", details="{name}"):
    machine: str; name: str
class ControllerAway(Reason, text="the controller of {machine} is not there", details="{name}"): machine: str; name: str
class ControllerLeft(Reason, text="the controller of {machine} went away during its goal", details="{name}"):
    machine: str; name: str
class ControllerEnded(Reason, text="the controller of {machine} ended it", details="{outcome}"):
    machine: str; outcome: str
class CancelledElsewhere(Reason, text="somebody else cancelled the motion at the machine"): pass
class GatewayStood(Reason, text="the gateway itself did not run for {seconds}"): seconds: Seconds
class GatewayStopped(Reason, text="the gateway was stopped; {stood}"): stood: Reason
class GatewayRestarted(Reason, text="{process} was restarted"): process: str
class GatewayRestartedHeld(Reason, text="{process} was restarted while {holder} held it"): process: str; holder: str
class GatewayRestartedUnproven(Reason, text="{process} was restarted before a stop of its machine was proven"):
    process: str
class TakenByAnother(Reason, text="{cause}, and another run took it"): cause: Reason
class NoRunTold(Reason, text="{cause}, and no run told of it"): cause: Reason
class TooLong(Reason, text="the motion takes too long"): pass
class WhileMoving(Reason, text="{why}, while it moves"): why: Reason
class Frozen(Reason, text="{source} are the same to the last bit for {seconds} while the machine should move"):
    source: Reason; seconds: Seconds
class Stalled(Reason, text="{joint} stands at {angle}, it should have passed {due}"):
    joint: str; angle: Radians; due: Radians
class OffPath(Reason, text="{joint} is at {angle}, its way has been between {low} and {high}"):
    joint: str; angle: Radians; low: Radians; high: Radians
class GivenBack(Reason, text="given back by {person}"): person: str
class ManualOn(Reason, text="the machine's own manual mode was switched on"): pass
class ManualOff(Reason, text="the machine's own manual mode was switched off"): pass
class NoEnd(Reason, text="stopped, but the gateway did not see the end of it", action=INSPECT): pass

# what the machine tells of itself
class JointStates(Reason, text="joint states"): pass
class Odometry(Reason, text="odometry"): pass
class Pose(Reason, text="pose"): pass
class Imu(Reason, text="IMU"): pass
class Unheard(Reason, text="no {source} from the machine yet", action=INSPECT): source: Reason
class UnheardOf(Reason, text="no {source} of {part} from the machine yet", action=INSPECT): source: Reason; part: str
class Old(Reason, text="{source} {age} old"): source: Reason; age: Seconds
class OldOf(Reason, text="{source} of {part} {age} old"): source: Reason; part: str; age: Seconds
class NoSource(Reason, text="the border declares no source that tells of its motion", action=EDIT_CONFIG): pass
class ManyPublishers(Reason, text="{source} come from {count} publishers", details="{nodes}"):
    source: Reason; count: int; nodes: tuple[str, ...]
class TwoPublishers(Reason, text="{source} come from two publishers: their numbers go back and forth"): source: Reason
class StampRepeated(Reason, text="{source} repeat a stamp that does not advance"): source: Reason
class Implausible(Reason, text="{source} are implausible: {part}: {why}"): source: Reason; part: str; why: Reason
class PositionsMove(Reason, text="positions move, velocities say that it stands"): pass
class VelocitiesMove(Reason, text="velocities say that it moves, positions stand"): pass
class NewClock(Reason, text="{source}: {why}"): source: Reason; why: Reason
class ClockAhead(Reason, text="their stamps are {seconds} ahead of {clock}"): seconds: Seconds; clock: Reason
class ClockBack(Reason, text="{clock} jumped back by {seconds}"): clock: Reason; seconds: Seconds
class UtcClock(Reason, text="the clock of the PC that stamps them (UTC)"): pass
class SimulatorClock(Reason, text="the simulator's clock"): pass
class Beyond(Reason, text="{source}: {joint} is told at {angle}, where it cannot be (limit {limit})"):
    source: Reason; joint: str; angle: Radians; limit: Radians
class StrangeType(Reason, text="{source} come as another type of message than the machine file says",
    action=EDIT_CONFIG, details="{node} publishes {topic} as {found}, which is no {wanted}"):
    source: Reason; node: str; topic: str; found: str; wanted: str
class Moving(Reason, text="still moving"): pass
class NotLongEnough(Reason, text="not seen to stand for long enough"): pass
class GoalOpen(Reason, text="its goal is still open"): pass
class ByArrival(Reason, text="by arrival: {sources} not stamped"): sources: tuple[Reason, ...]
class NotOnDisk(Reason, text="not on the disk: {problem}"): problem: str

# re-arm, take, give back
class NotStopped(Reason, text="{machine} is armed: there is nothing to do"): machine: str
class StillActive(Reason, text="{machine} still has an open goal", action=STATUS): machine: str
class CausePersists(Reason, text="{why}"): why: Reason
class StillPressed(Reason, text="the software stop is still pressed", action=RELEASE_STOP,
    details="false on /emergency_signal"): pass
class NotSeen(Reason, text="it cannot be seen whether {machine} stands: {why}", action=INSPECT):
    machine: str; why: Reason
class NotBelieved(Reason, text="what {machine} tells cannot be believed: {why}", action=INSPECT):
    machine: str; why: Reason
class StillProven(Reason, text="a stop of {machine} is still being proven", action=RETRY): machine: str
class NotStill(Reason, text="{machine} does not stand still yet", action=RETRY): machine: str
class BadToken(Reason, text="{why}"): why: Reason
class TokenUnknown(Reason, text="this token is not valid (any more): look at the machine, and begin anew",
    action=RETRY): pass
class TokenOld(Reason, text="the token is older than {limit}: begin anew", action=RETRY): limit: Seconds
class NotKept(Reason, text="{why}"): why: Reason
class StateNotKept(Reason, text="the note of its state cannot be written: make room on the disk of this PC",
    details="{problem}"): problem: str
class DriverNotKept(Reason, text="the note of who drives cannot be written: make room on the disk of this PC",
    details="{problem}"): problem: str
class NoteUnreadable(Reason, text="the note of how the machine was left cannot be read", action=INSPECT): pass
class Nameless(Reason, text="say who drives"): pass
class HeldByRun(Reason, text="run {run} holds {machine}", action=CANCEL): run: str; machine: str
class NotTaken(Reason, text="{machine} is not taken", action=STATUS): machine: str

# its own life
class Rival(Reason, text="another gateway for {machine} runs ({where})", action=PROCESSES): machine: str; where: str
class LooksForRivals(Reason, text="looks for another gateway"): pass
