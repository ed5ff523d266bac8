"""Has the machine's gateway execute a trajectory, and watches it to its end."""

from collections.abc import Callable

from control_msgs.action import FollowJointTrajectory

from tms_config.clock import monotonic
from tms_config.naming import process_of
from tms_control.reasons import PathBlocked
from tms_decision import STOP_PROVEN
from tms_decision.reasons import ProcessLost
from tms_machine import stamps
from tms_machine.reasons import MotionNotEnded, NoReason
from tms_reason import wire
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_ros.client import Call, Peer
from tms_ros.goals import Outcome
from tms_ros.reasons import LostMeanwhile, NoAnswer
from tms_ros.server import AnyGoal
from tms_rp.messages import follow
from tms_rp.reasons import MotionFailed, MotionLate, MoveOf
from tms_rp.trajectory import Trajectory
from tms_runtime.fence import derived

SERVER_LIMIT = 3.0  # s for the gateway to be there
ACCEPT_LIMIT = 5.0  # s for the gateway to answer; it does so without calls of its own
OVERRUN = 20.0  # s beyond the trajectory's own duration: the gateway gives up after 10 s and needs 5 s to stop
MOTION_END_LIMIT = STOP_PROVEN + 2.0  # s for a cancelled motion to have ended
CHECK_PERIOD = 0.5  # s between checks whether the gateway is still there, and whether the way is still free

Gateway = Peer[FollowJointTrajectory.Goal, FollowJointTrajectory.Result, FollowJointTrajectory.Feedback]
TrajectoryCall = Call[FollowJointTrajectory.Result, FollowJointTrajectory.Feedback]


class WayBlocked(SubtaskFailed):
    """Something has come into the way of a motion; the machine was seen to stand since.

    `seconds`: how far the motion was, from its begin.
    """

    def __init__(self, reason: Reason, seconds: float) -> None:
        super().__init__(reason)
        self.seconds = seconds


class Mover:
    """Sends trajectories to one machine's gateway."""

    def __init__(self, peer: Gateway) -> None:
        self._peer, self._process = peer, process_of(peer.name)
        self._machine = self._process.split(":")[0]

    def move(
        self, goal: AnyGoal, made: Trajectory, say: Callable[[Reason], None], blocked: Callable[[float], Reason | None]
    ) -> Outcome:
        """Execute `made` for `goal` and report the progress; SUCCEEDED, or CANCELED once the machine has stopped.

        `blocked` tells why it must not go on, so many seconds after its begin; it is asked again and again.

        Raises:
            WayBlocked: for the reason that `blocked` has told.
            SubtaskFailed, RosError: anything else, with the reason; the motion was cancelled then.
        """
        self._peer.wait_ready(SERVER_LIMIT)
        if goal.cancelled.is_set():
            return Outcome.CANCELED
        progress = _Progress(made, say)
        call = self._peer.send(follow(made), goal_id=derived(goal.uuid), on_feedback=progress)
        goal.on_cancel = call.changed  # wakes the waits below
        call.wait_for(lambda: call.accepted or _over(goal, call), ACCEPT_LIMIT)
        if not call.accepted and not _over(goal, call):
            self._stop(call)
            raise SubtaskFailed(NoAnswer(self._process, self._peer.name, ACCEPT_LIMIT))
        lost = self._watch(goal, call, monotonic() + made.duration + OVERRUN, lambda: blocked(progress.seconds))
        if call.outcome is None:
            self._stop(call)
        if lost is not None and lost.find(PathBlocked) is not None and call.outcome is Outcome.CANCELED:
            raise WayBlocked(lost, progress.seconds)
        if lost is not None:
            raise SubtaskFailed(lost)
        return _verdict(goal, call, self._peer.name)

    def _watch(
        self, goal: AnyGoal, call: TrajectoryCall, deadline: float, blocked: Callable[[], Reason | None]
    ) -> Reason | None:
        """Wait for the end of the motion or for a cancel; the reason when neither came."""
        while not _over(goal, call):
            if monotonic() > deadline:
                return MotionLate(self._machine, OVERRUN)
            if self._peer.left():
                self._peer.mark_lost()  # it ended in order, but without a result
            if why := blocked():
                return why
            call.wait_for(lambda: _over(goal, call), min(CHECK_PERIOD, deadline - monotonic()))
        return None

    def _stop(self, call: TrajectoryCall) -> None:
        """Cancel the motion and wait until it has ended."""
        self._peer.cancel(call)
        if not call.wait_for(lambda: call.outcome is not None, MOTION_END_LIMIT):
            raise SubtaskFailed(MotionNotEnded(self._machine))


class _Progress:
    """Turns the controller's feedback into progress, and reports each step once."""

    def __init__(self, made: Trajectory, say: Callable[[Reason], None]) -> None:
        self._made, self._say = made, say
        self._said: Reason | None = None
        self._begun = monotonic()
        self.seconds = 0.0  # since the begin of the trajectory, as far as the controller has told

    def __call__(self, feedback: FollowJointTrajectory.Feedback) -> None:
        at = feedback.desired.time_from_start
        # Not every controller fills in its time; else the clock gives it.
        seconds = stamps.seconds(at) or monotonic() - self._begun
        self.seconds = seconds
        number, percent = self._made.progress(seconds)
        progress = MoveOf(number, len(self._made.stops), percent)
        if progress != self._said:
            self._said = progress
            self._say(progress)


def _over(goal: AnyGoal, call: TrajectoryCall) -> bool:
    return call.outcome is not None or goal.cancelled.is_set()


def _verdict(goal: AnyGoal, call: TrajectoryCall, name: str) -> Outcome:
    if call.outcome is Outcome.SUCCEEDED and not goal.cancelled.is_set():
        return Outcome.SUCCEEDED
    if goal.cancelled.is_set() and call.outcome not in (Outcome.ABORTED, Outcome.LOST):
        return Outcome.CANCELED  # also if it arrived, or was refused, just before: the machine does not move
    if call.outcome is Outcome.LOST:
        raise SubtaskFailed(ProcessLost(LostMeanwhile(process_of(name), name)))
    why = wire.of(getattr(call.result, "error_string", "")) or NoReason()
    raise SubtaskFailed(MotionFailed(why, name, call.outcome.name if call.outcome else "LOST"))
