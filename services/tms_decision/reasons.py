"""Why a machine may not move, why it is stopped, and why a stop is not proven."""

from tms_reason.quantities import Metres, Moments, Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import CANCEL, GIVE_BACK, INSPECT, LOGS, REARM, RELEASE_STOP, RESUME, RETRY, STATUS


# fmt: off
# who stands behind a goal
class NoPermit(Reason, text="no motion permit: {why}"): why: Reason
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
class DrivenByHand(Reason, text="{driver} drives {machine} by hand", action=GIVE_BACK, code="TAKEN"):
    driver: Reason; machine: str
class ManualMode(Reason, text="a person at the machine's own levers"): pass

# stops, and their causes
class SoftwareStop(Reason, text="software stop"): pass
class SoftwareStopBy(SoftwareStop, text="software stop by {person}"): person: str
class SoftwareStopSaying(SoftwareStop, text="software stop: {why}"): why: Reason
class NoNote(Reason, text="it is not known on this PC how the machine was left", action=INSPECT): pass
class MachineLatched(Reason, text="{machine} is stopped: {cause}", action=REARM): machine: str; cause: Reason
class ProcessLost(Reason, text="{why}"): why: Reason
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
class GivenBack(Reason, text="given back by {person}"): person: str
class ManualOn(Reason, text="the machine's own manual mode was switched on"): pass
class ManualOff(Reason, text="the machine's own manual mode was switched off"): pass
class NoEnd(Reason, text="stopped, but the gateway did not see the end of it", action=INSPECT): pass

# how far a stop went
class Stood(Reason, text="stood after {seconds}, {angle} ({joint}) and {way}: {cause}"):
    seconds: Moments; angle: Radians; joint: str; way: Metres; cause: Reason
class StoodWithoutJoints(Reason, text="stood after {seconds}, {way}: {cause}"):
    seconds: Moments; way: Metres; cause: Reason
class StopUnconfirmed(Reason, text="STOP UNCONFIRMED: {detail} ({cause})", action=INSPECT):
    detail: Reason; cause: Reason

# what the machine tells of itself
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
class Nameless(Reason, text="say who drives"): pass
class HeldByRun(Reason, text="run {run} holds {machine}", action=CANCEL): run: str; machine: str
class NotTaken(Reason, text="{machine} is not taken", action=STATUS): machine: str

# how a run ends
class StopRequested(Reason, text="{machine} was told to stop: {cause}"): machine: str; cause: Reason
class SchedulerWasLost(Reason, text="the scheduler was lost"): pass
class SeenToStand(Reason, text="seen to stand: {machines}"): machines: tuple[str, ...]
class NotSeenStanding(Reason, text="not seen to stand: {machines}"): machines: tuple[str, ...]
class RunInterrupted(Reason, text="{seen}", action=RESUME): seen: tuple[Reason, ...]; run: str
class NotResumed(Reason, text="not resumed: {why}"): why: Reason
class HaltedGoalsEnd(Reason, text="the tree has succeeded, and goals that it halted still end"): pass
class GoalNotEnded(Reason, text="{goal} has not ended its goal"): goal: str
class MachineUnconfirmed(Reason, text="{machine}: {why}"): machine: str; why: Reason
class NoReceipt(Reason, text="not seen to stand: no receipt of a stop came within {limit}"): limit: Seconds

# goals of leaves, as the history of a run tells them
class NotRepeatedDone(Reason, text="{goal} is not repeated: succeeded before the interruption"): goal: str
class NotRepeatedFailed(Reason, text="{goal} is not repeated: failed before the interruption"): goal: str
class FailedBefore(Reason, text="failed before"): pass
class SentAgainSoon(Reason, text="it failed just now and is sent again soon"): pass
class GoalSent(Reason, text="sent to {goal}, record {record}"): goal: str; record: str
class GoalAccepted(Reason, text="{goal} accepted"): goal: str
class GoalSucceeded(Reason, text="{goal} succeeded"): goal: str
class GoalCancelled(Reason, text="{goal} was cancelled"): goal: str
class GoalRefused(Reason, text="{goal} refused the goal: {why}"): goal: str; why: Reason
class GoalGaveUp(Reason, text="{goal} gave up: {why}"): goal: str; why: Reason
class GoalLost(Reason, text="{goal}: {why}"): goal: str; why: Reason
class ForTooLong(Reason, text="{why}, for {seconds}"): why: Reason; seconds: Seconds
class LostTimes(Reason, text="{why} (lost {times} times)"): why: Reason; times: int
class SentAgain(Reason, text="{why}; sent again when the process is back"): why: Reason
class SentAgainTimes(Reason, text="{why}; sent again when the process is back ({loss}/{retries})"):
    why: Reason; loss: int; retries: int
class MachineStopping(Reason, text="{machine} is being stopped"): machine: str
class LastGoalOpen(Reason, text="{machine} has not ended its last goal yet"): machine: str
class ProcessAway(Reason, text="{process} is not there", action=LOGS): process: str
class ProcessEnded(Reason, text="process {process} ended during its goal", action=LOGS): process: str
