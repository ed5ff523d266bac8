"""Sends the goals of leaf nodes to the subtasks; a machine gets its next goal only after its last one has ended."""

import threading
from collections.abc import Callable
from dataclasses import dataclass

from prometheus_client import Histogram
from tms_msg_ts.action import LeafNodeBase

from tms_config.clock import monotonic
from tms_decision.owner import LEAVES, Owner
from tms_decision.reasons import MachineLatched, NoPermit, ProcessLost
from tms_machine.reasons import NoDatabase, NoJointState, NoReason, Rejected
from tms_reason.reason import Reason
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_ros.reasons import LostMeanwhile, NoAnswer, NoServer
from tms_runtime.fence import goal_id
from tms_ts.gateways import Gateways
from tms_ts.hosts import Hosts
from tms_ts.interrupted_run import Key
from tms_ts.machine_stops import LogEvent, MachineStops
from tms_ts.reasons import (
    FailedBefore,
    ForTooLong,
    GoalAccepted,
    GoalCancelled,
    GoalGaveUp,
    GoalLost,
    GoalRefused,
    GoalSent,
    GoalSucceeded,
    LastGoalOpen,
    LostTimes,
    MachineStopping,
    NotRepeatedDone,
    NotRepeatedFailed,
    ProcessAway,
    ProcessEnded,
    SentAgain,
    SentAgainSoon,
    SentAgainTimes,
)
from tms_ts.replay import Replay
from tms_ts.run_checkpoint import RunCheckpoint
from tms_ts.sent_goal import ACCEPT_LIMIT, LeafCall, LeafPeer, SentGoal
from tms_ts.world import GoalState

SERVER_LIMIT = 10.0  # s for a subtask's server to be there
DATABASE_LIMIT = 15.0  # s that a leaf waits for a database that is away
ASK_AGAIN = 0.5  # s until a goal is sent again, also after a failure: a loop around a leaf must not flood the history
AWAY = (NoDatabase.code, "STORE_DOWN")  # why a subtask refuses a goal when its record cannot be read now
# Reasons with which a goal fails while a process is being restarted.
UNREACHED = (NoAnswer, NoServer, Rejected, NoJointState, NoPermit)

HANDOVER = Histogram(
    "tms_ts_handover_seconds", "From the result of one leaf of a run to the acceptance of the next goal",
    buckets=(0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.5, 1, 5),
)  # fmt: skip


@dataclass(frozen=True)
class Identity:
    """Identifies the run whose goals these are."""

    number: int  # fencing number
    retries: int  # times that a goal is sent again after a loss
    record: RunCheckpoint
    replay: Replay


class Machines:
    """The goals of one run. Called by the run's thread; answers come on the executor thread and wake it."""

    def __init__(
        self,
        ros: Ros,
        hosts: Hosts,
        gateways: Gateways,
        wake: Callable[[], None],
        log_event: LogEvent,
        identity: Identity,
    ) -> None:
        self._ros, self._hosts, self._gateways = ros, hosts, gateways
        self._wake, self._log_event = wake, log_event
        self.stops = MachineStops(ros, gateways, log_event)
        self._number, self._retries = identity.number, identity.retries
        self._record, self._replay = identity.record, identity.replay
        self._leaves = 0  # goals sent so far
        self._handed_over: float | None = None  # monotonic time of the last result, until the next goal is accepted
        self._failed: dict[Key, float] = {}  # monotonic time of each goal's last failure
        self._given_up: set[Reason] = set()  # processes that supervisord has given up, already in the journal
        self._open: list[SentGoal] = []
        self._stopping: set[str] = set()  # machines that are being stopped after a lost goal

    def peer(self, machine: str, subtask: str) -> LeafPeer:
        """A subtask's action server; asking early lets discovery happen before the first goal."""
        return self._ros.peer(LeafNodeBase, f"/{machine}/{subtask}")

    def send(self, machine: str, subtask: str, record: str, node: str) -> SentGoal:
        """Begin a goal; it is sent at once if the machine is free and the server is there."""
        goal = SentGoal(machine, subtask, record, node)
        before = self._replay.take(goal.key)
        if before is not None:
            goal.state, goal.reason = (GoalState.SUCCEEDED, None) if before else (GoalState.FAILED, FailedBefore())
            self._log_event("goal", node, NotRepeatedDone(goal.name) if before else NotRepeatedFailed(goal.name))
            return goal
        goal.peer = self.peer(machine, subtask)
        if goal.key in self._failed:
            goal.not_before = self._failed[goal.key] + ASK_AGAIN
            goal.reason = SentAgainSoon()
        self._open.append(goal)
        self._try_send(goal)
        return goal

    def advance(self) -> None:
        """Send waiting goals, detect lost ones, forget ended ones."""
        for goal in list(self._open):
            if goal.call is None and not goal.state.final:
                self._try_send(goal)
            elif goal.call is not None and goal.call.outcome is None:
                self._look_for_loss(goal, goal.call)
            if goal.state.final and (goal.call is None or goal.call.outcome is not None):
                self._open.remove(goal)

    def settled(self) -> bool:
        """Whether every goal is terminal and no machine is being stopped."""
        self.advance()
        return not self._open and not self._stopping

    def open_goals(self) -> list[str]:
        """Names of the goals that have not ended."""
        return [goal.name for goal in self._open]

    def _try_send(self, goal: SentGoal) -> None:
        assert goal.peer is not None
        if goal.cancelled:  # cancelled while it waited to be sent again
            self._end(goal, GoalState.CANCELLED, GoalCancelled(goal.name))
            return
        if monotonic() < goal.not_before:
            return
        goal.reason = self._obstacle(goal)
        if goal.reason is not None:
            gone = self._gone_for_good(goal)
            if gone is not None:
                self._end(goal, GoalState.FAILED, gone)
            elif monotonic() - goal.begun > SERVER_LIMIT:
                self._end(goal, GoalState.FAILED, ForTooLong(goal.reason, SERVER_LIMIT))
            return
        goal.pid = self._hosts.pid(goal.machine, goal.subtask)
        request = LeafNodeBase.Goal(model_name=goal.machine, record_name=goal.record)
        goal.begun = monotonic()
        self._log_event("goal", goal.node, GoalSent(goal.name, goal.record))
        self._leaves = self._leaves % LEAVES + 1
        uuid = goal_id(Owner(self._number, self._leaves))
        self._record.sent(goal.key)
        goal.call = goal.peer.send(request, goal_id=uuid, on_change=lambda call: self._changed(goal, call))

    def _obstacle(self, goal: SentGoal) -> Reason | None:
        """Why the goal cannot be sent now."""
        if goal.machine in self._stopping:
            return MachineStopping(goal.machine)
        before = [other for other in self._open if other.cancelled and other.machine == goal.machine]
        if any(other.call is not None and other.call.outcome is None for other in before):
            return LastGoalOpen(goal.machine)
        for process in ("rc", "rp", goal.subtask):
            trouble = self._hosts.trouble(goal.machine, process)
            if trouble and (goal.losses or process == goal.subtask):
                return trouble
        if goal.peer is not None and not goal.peer.ready():
            return ProcessAway(goal.name)
        return self._gateways.obstacle(goal.machine)

    def _gone_for_good(self, goal: SentGoal) -> Reason | None:
        """Why waiting cannot help: supervisord has given up a process, or only a person can re-arm the machine."""
        latch = self._gateways.latch(goal.machine)
        if latch is not None:
            return MachineLatched(goal.machine, latch)
        fatal = next(filter(None, (self._hosts.fatal(goal.machine, p) for p in ("rc", "rp", goal.subtask))), None)
        if fatal is not None and fatal not in self._given_up:
            self._given_up.add(fatal)
            self._log_event("alarm", goal.node, fatal)
        return fatal

    def _changed(self, goal: SentGoal, call: LeafCall) -> None:
        """Handle a step of the action protocol, on the executor thread."""
        if call.outcome is Outcome.LOST if goal.call is None else call is not goal.call:
            return  # an old call of a goal that is sent again (None alone: `send` has not returned the call yet)
        if call.outcome is not None and not goal.state.final:
            self._ended(goal, call)
        elif call.accepted and goal.state is GoalState.SENDING:
            goal.state = GoalState.RUNNING
            if self._handed_over is not None:
                HANDOVER.observe(monotonic() - self._handed_over)
                self._handed_over = None
            self._log_event("goal", goal.node, GoalAccepted(goal.name))
        self._wake()

    def _ended(self, goal: SentGoal, call: LeafCall) -> None:
        if call.outcome is Outcome.SUCCEEDED:
            self._end(goal, GoalState.SUCCEEDED, None)
            self._handed_over = monotonic()
        elif call.outcome is Outcome.CANCELED:
            self._end(goal, GoalState.CANCELLED, GoalCancelled(goal.name))
        else:
            self._failed_with(goal, call, goal.feedback or NoReason())

    def _failed_with(self, goal: SentGoal, call: LeafCall, why: Reason) -> None:
        if (why.code in AWAY and self._may_wait(goal)) or self._may_ask_again(goal, why):
            goal.reason, goal.state = why, GoalState.SENDING
            goal.call, goal.begun, goal.not_before = None, monotonic(), monotonic() + ASK_AGAIN
        elif why.find(ProcessLost) is not None:
            self._lost(goal, GoalLost(goal.name, why))
        elif call.outcome is Outcome.REJECTED:
            self._end(goal, GoalState.FAILED, GoalRefused(goal.name, why))
        else:
            self._end(goal, GoalState.FAILED, GoalGaveUp(goal.name, why))

    def _may_ask_again(self, goal: SentGoal, why: Reason) -> bool:
        """Whether to send again soon after a loss: the processes below may not have discovered each other yet."""
        return goal.recovers() and not goal.cancelled and any(why.find(kind) is not None for kind in UNREACHED)

    def _may_wait(self, goal: SentGoal) -> bool:
        """Whether a subtask that cannot read its record is asked again: the database may be coming back."""
        goal.waits_since = goal.waits_since or monotonic()
        return not goal.cancelled and monotonic() - goal.waits_since < DATABASE_LIMIT

    def _end(self, goal: SentGoal, state: GoalState, reason: Reason | None) -> None:
        if state is not GoalState.SUCCEEDED and not goal.cancelled:
            self._failed[goal.key] = monotonic()
        if state is not GoalState.CANCELLED and not goal.cancelled:
            for key, left in self._replay.moved_on(goal.node):
                self._record.gone(key, left)
            self._record.done(goal.key, state is GoalState.SUCCEEDED)
        goal.reason, goal.state = reason, state  # last: the tree may see it now and ask for the next goal
        self._log_event("goal", goal.node, reason or GoalSucceeded(goal.name))

    def _look_for_loss(self, goal: SentGoal, call: LeafCall) -> None:
        """End a goal whose server is gone and never answers, and stop the machine that it may have left moving."""
        why = self._loss(goal)
        if why is None:
            return
        final = goal.state.final
        unreceived = goal.unreceived()
        goal.call = None if not final else call
        if unreceived and goal.peer is not None:
            goal.peer.cancel(call)  # in case it is accepted after all
        call.end(Outcome.LOST)
        if goal.peer is not None and self._replaced(goal):
            goal.peer.mark_lost()
        if not final:
            self._lost(goal, why, counts=not (unreceived and goal.recovers()))

    def _lost(self, goal: SentGoal, why: Reason, *, counts: bool = True) -> None:
        """Handle the loss of a process during a goal: have the machine stopped, then send the goal again, a few times.

        `counts`: a server that does not answer soon after a loss has not discovered us yet, which is no further loss.
        """
        if counts:
            goal.losses += 1
            goal.lost_at = monotonic()
        self._stopping.add(goal.machine)
        if goal.cancelled:
            self._end(goal, GoalState.CANCELLED, why)
        elif goal.losses > self._retries:
            self._end(goal, GoalState.FAILED, LostTimes(why, goal.losses))
        else:
            goal.call, goal.state, goal.begun = None, GoalState.SENDING, monotonic()
            goal.not_before = goal.begun + ASK_AGAIN * goal.losses
            goal.reason = SentAgain(why)
            self._log_event("loss", goal.node, SentAgainTimes(why, goal.losses, self._retries))
        threading.Thread(target=self._stop_after_loss, args=(goal.machine, why), daemon=True).start()

    def _loss(self, goal: SentGoal) -> Reason | None:
        if goal.unreceived():
            return NoAnswer(goal.name, goal.action, ACCEPT_LIMIT)
        if self._replaced(goal):
            return ProcessEnded(goal.name)
        gone = goal.peer is not None and not goal.peer.ready()
        return LostMeanwhile(goal.name, goal.action) if gone else None

    def _replaced(self, goal: SentGoal) -> bool:
        """Whether the subtask is another process now than when the goal was sent."""
        now = self._hosts.pid(goal.machine, goal.subtask)
        return goal.pid is not None and now is not None and now != goal.pid

    def _stop_after_loss(self, machine: str, cause: Reason) -> None:
        self.stops.receipt(self.stops.stop(machine, cause))
        self._stopping.discard(machine)
        self._wake()
