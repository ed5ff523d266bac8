"""Sends a run to its scheduler, which may have been restarted a moment ago."""

from collections.abc import Callable

from tms_msg_ts.action import ExecuteTask

from tms_config.naming import process_of
from tms_reason.errors import RosError
from tms_ros.client import DISCOVERY_LEASE, Call, Peer
from tms_ros.goals import Outcome
from tms_schedulers.reasons import RunNotBegun

ExecutePeer = Peer[ExecuteTask.Goal, ExecuteTask.Result, ExecuteTask.Feedback]
ExecuteCall = Call[ExecuteTask.Result, ExecuteTask.Feedback]
LIMIT = 4.0  # s for the scheduler to be there, and to say whether it knows a goal


def send(
    scheduler: ExecutePeer, goal: ExecuteTask.Goal, on_feedback: Callable[[ExecuteTask.Feedback], None] | None = None
) -> ExecuteCall:
    """Send a run, and wait until the scheduler has answered; at most some 6 s, as this one should within moments.

    For some seconds, discovery counts a process that was killed: a goal that finds no other one then gets lost. Once
    that is over, the goal is sent again if the successor says that it does not know it, and ended if it has taken it.

    Raises:
        RosError: NO_SERVER; or it took the goal too late, and was asked to end it.
        KeyboardInterrupt: the goal was asked to end, too.
    """

    def sent() -> ExecuteCall:
        scheduler.wait_ready(LIMIT)
        return scheduler.send(goal, on_feedback=on_feedback)

    call = sent()
    try:
        answered = call.wait_for(lambda: call.accepted or call.outcome is not None, DISCOVERY_LEASE)
    except KeyboardInterrupt:  # of `tms run`, which would end before its cancel has left
        scheduler.cancel(call)
        call.wait_for(lambda: call.outcome is not None, LIMIT)
        raise
    if not answered:
        scheduler.resolve_unanswered(call)
        call.wait_for(lambda: call.outcome is not None, LIMIT)
        if call.outcome is Outcome.LOST:
            return sent()
        if call.outcome is Outcome.CANCELED:
            raise RosError(RunNotBegun(DISCOVERY_LEASE, process_of(scheduler.name)))
    return call
