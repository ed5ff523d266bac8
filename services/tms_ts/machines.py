"""Sends the goals of leaf nodes to the subtasks, as `tms_decision.leaf` decides."""

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from prometheus_client import Histogram
from tms_msg_ts.action import LeafNodeBase

from tms_config.clock import monotonic
from tms_config.config import Site
from tms_decision.leaf import effects as f
from tms_decision.leaf import events as e
from tms_decision.leaf.replay import Replay
from tms_decision.leaf.state import ACCEPT_LIMIT, LeafGoals
from tms_decision.leaf.step import ask, step
from tms_decision.reasons import NoPermit, ProcessLost
from tms_machine.leaf_forms import own_action
from tms_machine.reasons import NoDatabase, NoJointState, NoReason, Rejected
from tms_reason.reason import Reason
from tms_ros.client import Call, Peer
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_ros.reasons import LostMeanwhile, NoAnswer, NoServer
from tms_runtime.fence import goal_id
from tms_ts.gateways import Gateways
from tms_ts.hosts import Hosts
from tms_ts.machine_stops import LogEvent, MachineStops
from tms_ts.run_checkpoint import RunCheckpoint
from tms_ts.sent_goal import SentGoal, feedback

NO_STORE = (NoDatabase.code, "STORE_DOWN")  # why a subtask refuses a goal when its record cannot be read now
# Reasons with which a goal fails while a process is being restarted.
UNREACHED = (NoAnswer, NoServer, Rejected, NoJointState, NoPermit)
LOOK_PERIOD = 0.2  # s between looks for the server of a goal that it has got: each goes through all ends of the graph

LeafPeer = Peer[LeafNodeBase.Goal, LeafNodeBase.Result, LeafNodeBase.Feedback]
LeafCall = Call[LeafNodeBase.Result, LeafNodeBase.Feedback]

HANDOVER = Histogram(
    "tms_ts_handover_seconds", "From the result of one leaf of a run to the acceptance of the next goal",
    buckets=(0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 5),
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
        site: Site,
        hosts: Hosts,
        gateways: Gateways,
        wake: Callable[[], None],
        log_event: LogEvent,
        identity: Identity,
    ) -> None:
        self._ros, self._site, self._hosts, self._gateways, self._wake = ros, site, hosts, gateways, wake
        self.stops = MachineStops(ros, gateways, log_event)
        self._goals = LeafGoals(identity.number, identity.retries, identity.replay)
        self._lock = threading.RLock()  # guards the goals; held for moments only
        self._coming: deque[e.Event] = deque()
        self._stepping = False
        self._asked = 0
        self._ended_at: float | None = None  # monotonic time of the last success, until the next goal is accepted
        self._sent: dict[int, tuple[LeafPeer, LeafCall]] = {}  # by sending, those that are open
        self._looked: dict[LeafPeer, float] = {}  # when a server was last seen to be there, monotonic
        record = identity.record
        self._doers: dict[type[f.Effect], Callable[[Any], None]] = {
            f.Send: self._send, f.Cancel: self._cancel, f.Lose: self._lose, f.StopMachine: self._stop,
            f.Note: lambda effect: log_event(effect.kind, effect.node, effect.what),
            f.KeepSent: lambda effect: record.sent(effect.key),
            f.KeepDone: lambda effect: record.done(effect.key, effect.succeeded),
            f.KeepGone: lambda effect: record.gone(effect.key, effect.left),
        }  # fmt: skip

    def peer(self, machine: str, subtask: str) -> LeafPeer:
        """A subtask's action server; asking early lets discovery happen before the first goal."""
        return self._ros.peer(*own_action(self._site, machine, subtask))

    def send(self, machine: str, subtask: str, record: str, node: str) -> SentGoal:
        """Begin a goal; it is sent at once if the machine is free and the server is there."""
        key, name, action = (node, machine, subtask, record), f"{machine}:{subtask}", f"/{machine}/{subtask}"
        no_answer, away = NoAnswer(name, action, ACCEPT_LIMIT), LostMeanwhile(name, action)
        with self._lock:
            self._asked += 1
            number = self._asked
            seen = self._seen(key, sent=False)
            goal, effects = ask(self._goals, e.GoalAsked(number, key, seen, no_answer, away), monotonic())
            self._do(effects)
        return SentGoal(goal, lambda: self._call(goal.call), lambda: self._happened(e.CancelAsked(number)))

    def advance(self) -> None:
        """Send waiting goals, and detect lost ones."""
        with self._lock:
            if self._goals.open:
                seen = {goal.asked.number: self._seen(goal.key, sent=goal.call != 0) for goal in self._goals.open}
                self._happened(e.Looked(seen))

    def settled(self) -> bool:
        """Whether every goal has ended and no machine is being stopped."""
        self.advance()
        with self._lock:
            return self._goals.settled()

    def open_goals(self) -> list[str]:
        """Names of the goals that have not ended."""
        with self._lock:
            return [goal.name for goal in self._goals.open]

    def _seen(self, key: e.Key, sent: bool) -> e.Seen:
        """What is seen of the processes that a goal needs; `sent`: its server has got it."""
        _, machine, subtask, _ = key
        hosts, gateways, processes = self._hosts, self._gateways, ("rc", "rp", subtask)
        below = [hosts.trouble(machine, process) for process in ("rc", "rp")]
        given_up = [hosts.fatal(machine, process) for process in processes]
        return e.Seen(
            self._there(self.peer(machine, subtask), sent), hosts.pid(machine, subtask), hosts.age(machine, subtask),
            next(filter(None, below), None), hosts.trouble(machine, subtask), next(filter(None, given_up), None),
            gateways.obstacle(machine), gateways.latch(machine),
        )  # fmt: skip

    def _there(self, peer: LeafPeer, sent: bool) -> bool:
        """Whether a server is there; once it has got the goal, it is looked for less often, as a look is dear."""
        now = monotonic()
        if sent and now - self._looked.get(peer, 0.0) < LOOK_PERIOD:
            return True
        there = peer.ready()
        self._looked[peer] = now if there else 0.0
        return there

    # decisions

    def _happened(self, event: e.Event) -> None:
        """Let something happen; from any thread."""
        with self._lock:
            self._coming.append(event)
            if not self._stepping:  # else an effect made it happen
                self._do([])

    def _do(self, effects: list[f.Effect]) -> None:
        """Do these effects, then those of what has happened meanwhile."""
        self._stepping = True
        try:
            self._do_each(effects)
            while self._coming:
                self._do_each(step(self._goals, self._coming.popleft(), monotonic()))
        finally:
            self._stepping = False

    def _do_each(self, effects: list[f.Effect]) -> None:
        for effect in effects:
            self._doers[type(effect)](effect)

    # effects

    def _send(self, effect: f.Send) -> None:
        _, machine, subtask, record = effect.key
        peer, number = self.peer(machine, subtask), effect.call
        request = own_action(self._site, machine, subtask)[0].Goal()
        request.model_name, request.record_name = machine, record
        call = peer.send(request, goal_id=goal_id(effect.owner), on_change=lambda call: self._changed(number, call))
        self._sent[number] = peer, call

    def _cancel(self, effect: f.Cancel) -> None:
        peer, call = self._sent[effect.call]
        peer.cancel(call)

    def _lose(self, effect: f.Lose) -> None:
        peer, call = self._sent.pop(effect.call)
        call.end(Outcome.LOST)
        if effect.dead:
            peer.mark_lost()

    def _stop(self, effect: f.StopMachine) -> None:
        threading.Thread(target=self._stop_after_loss, args=(effect.machine, effect.cause), daemon=True).start()

    def _stop_after_loss(self, machine: str, cause: Reason) -> None:
        self.stops.receipt(self.stops.stop(machine, cause))
        self._happened(e.MachineStopped(machine))
        self._wake()

    # answers

    def _call(self, number: int) -> LeafCall | None:
        found = self._sent.get(number)
        return found[1] if found is not None else None

    def _changed(self, number: int, call: LeafCall) -> None:
        """Handle a step of the action protocol, on the executor thread."""
        if call.outcome is not None:
            with self._lock:
                self._happened(_ended(number, call, call.outcome))
                self._sent.pop(number, None)
            if call.outcome is Outcome.SUCCEEDED:
                self._ended_at = monotonic()
        elif call.accepted:
            self._happened(e.Accepted(number))
            if self._ended_at is not None:
                HANDOVER.observe(monotonic() - self._ended_at)
                self._ended_at = None
        self._wake()


def _ended(number: int, call: LeafCall, outcome: Outcome) -> e.Ended:
    why, failure = feedback(call) or NoReason(), e.NO_LOSS
    if why.code in NO_STORE:
        failure |= e.Failure.NO_STORE
    if any(why.find(kind) is not None for kind in UNREACHED):
        failure |= e.Failure.UNREACHED
    if why.find(ProcessLost) is not None:
        failure |= e.Failure.LOST
    return e.Ended(number, outcome.name, why, failure)
