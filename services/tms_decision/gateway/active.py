"""The goal that moves the machine, from the note that names it to its end."""

from tms_decision import reasons as r
from tms_decision.chain import gap
from tms_decision.gateway import notes, stops
from tms_decision.gateway.effects import End, Publish, Receipt, Send
from tms_decision.gateway.events import CallEnded, NoteKept, Reference, Turn
from tms_decision.gateway.state import Gateway, Goal, Phase
from tms_decision.gateway.stops import StopKind, stood_after
from tms_proof.following import Follower, Way, ways
from tms_reason.reason import Reason

SERVER_LIMIT = 3.0  # s for the machine's server to be there, and for the machine's messages to be received


def noted(gateway: Gateway, now: float, event: NoteKept) -> None:
    """A note is on the disk, or is not."""
    goal = gateway.active
    if goal is None or goal.phase is not Phase.NOTING or not goal.note or event.number < goal.note:
        return
    if event.problem is not None and event.number == goal.note and goal.stop is None:
        _finish(gateway, now, goal, "ABORTED", event.problem)
        return
    goal.note = 0
    go_on(gateway, now)


def go_on(gateway: Gateway, now: float) -> None:
    """Take the active goal as far as it can go now."""
    goal = gateway.active
    if goal is None:
        return
    if goal.stop is not None:
        if goal.stop.answer is not None:
            _finish(gateway, now, goal, *_stopped(gateway, goal, goal.stop.cause, goal.stop.answer))
        return
    if goal.phase is Phase.NOTING and not goal.note:
        goal.wait_for_look(Phase.REACHING, gateway, now)
    if goal.phase is Phase.REACHING:
        _reach(gateway, goal, now)
    if goal.phase is Phase.HEARING:
        _hear(gateway, goal, now)


def _reach(gateway: Gateway, goal: Goal, now: float) -> None:
    if goal.seen(gateway) and gateway.beat.ready:
        goal.enter(Phase.HEARING, now)
    elif now - goal.since >= SERVER_LIMIT:
        _finish(gateway, now, goal, "ABORTED", r.ControllerAway(gateway.facts.name, goal.asked.server))


def _hear(gateway: Gateway, goal: Goal, now: float) -> None:
    """Send the goal once all sources are heard, maybe later than by its sender: else its motion would be a latch."""
    silent = gateway.silent(now)
    if silent is not None and not goal.cancelled:
        if now - goal.since >= SERVER_LIMIT:
            _finish(gateway, now, goal, "ABORTED", r.NotReady(silent))
        return
    if (trouble := gateway.watch.trouble(now)) is not None:
        _finish(gateway, now, goal, "ABORTED", r.NotReady(trouble.reason))
        return
    _last_look(gateway, goal, now)
    if goal.stop is None:
        goal.sent, goal.start = now, gateway.watch.leaves(now)
        goal.enter(Phase.SENT, now)
        gateway.do(Send(goal.number))


def _last_look(gateway: Gateway, goal: Goal, now: float) -> None:
    """Stop a goal before it leaves if a loss or a cancel came since it was admitted."""
    refusal, missing = gateway.latch.refusal(goal.owner), gap(goal.owner, gateway.held(now))
    if refusal is not None:
        stops.stop(gateway, now, refusal, StopKind.PLAIN)
    elif missing is not None:
        lost = goal.owner is not None and not missing.late
        kind = StopKind.HOLD if lost else StopKind.PLAIN
        stops.stop(gateway, now, r.ProcessLost(missing.reason) if lost else missing.reason, kind)
    elif goal.cancelled:
        stops.stop(gateway, now, r.Cancelled(), StopKind.PLAIN)


def accepted(gateway: Gateway, now: float, number: int) -> None:
    """The machine's server has accepted the active goal: from now on the machine should follow."""
    goal = gateway.active
    if goal is None or goal.number != number or goal.phase is not Phase.SENT:
        return
    goal.enter(Phase.MOVING, now)
    goal.begun = now
    motion, watch, speed = goal.asked.motion, gateway.watch, gateway.facts.speed
    if isinstance(motion, Reference):
        goal.follower = Follower(ways(motion.names, motion.points, goal.start), watch.reached, now, speed)
    elif isinstance(motion, Turn) and motion.joint in goal.start:
        goal.follower = Follower(_turned(motion, goal.start), watch.reached, now, speed)


def _turned(motion: Turn, start: dict[str, float]) -> dict[str, Way]:
    """The reference at the slowest pace of the server."""
    seconds = abs(motion.angle - start[motion.joint]) / motion.velocity + motion.velocity / motion.acceleration
    return ways([motion.joint], [(seconds, [motion.angle])], start)


def ended(gateway: Gateway, now: float, event: CallEnded) -> None:
    """The machine's server has ended the active goal."""
    goal = gateway.active
    if goal is None or goal.number != event.number or goal.outcome:
        return
    goal.outcome = event.outcome
    if goal.stop is not None:
        stops.advance(gateway, now)
    elif event.outcome == "SUCCEEDED":
        _finish(gateway, now, goal, "SUCCEEDED")
    elif event.outcome == "CANCELED":  # not by our client: the standby of a gateway that seems lost did it
        _finish(gateway, now, goal, "ABORTED", r.ProcessLost(r.CancelledElsewhere()))
    else:
        why = None if event.explained else r.ControllerEnded(gateway.facts.name, event.outcome)
        _finish(gateway, now, goal, "ABORTED", why)


def _finish(gateway: Gateway, now: float, goal: Goal, outcome: str, why: Reason | None = None) -> None:
    """Answer the client: the goal moves the machine no more."""
    gateway.active, gateway.last = None, (goal, now)
    if goal.owner is None and goal.stop is None:
        notes.hold(gateway, "", 0)
    gateway.do(End(goal.number, outcome, why), Publish())


def _stopped(gateway: Gateway, goal: Goal, cause: Reason, receipt: Receipt) -> tuple[str, Reason]:
    if not receipt.confirmed:
        return "ABORTED", r.StopUnconfirmed(receipt.detail or cause, cause)
    stood = stood_after(receipt.seconds, receipt.joint, receipt.angle, receipt.way, cause)
    if not goal.cancelled or gateway.latch.cause is not None:
        return "ABORTED", stood
    return "CANCELED", r.ProcessLost(r.GatewayStopped(stood)) if gateway.leaving else stood
