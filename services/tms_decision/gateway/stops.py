"""Stops the machine and proves it: commands at once, watches until it was seen to stand, then tells.

The order of a stop is command, proof, note, receipt: a receipt is on the disk before it is published.
"""

from dataclasses import replace
from enum import Enum

from tms_decision import DISK_LIMIT, STOP_PROVEN
from tms_decision import reasons as r
from tms_decision.gateway import effects as f
from tms_decision.gateway import notes
from tms_decision.gateway.events import ReceiptKept
from tms_decision.gateway.state import Gateway, Goal, Stop
from tms_proof.proof import NOTHING, UNKNOWN, Expected
from tms_reason.reason import Reason, Several

AGAIN = 0.5  # s between repeated commands while it is not proven


class StopKind(Enum):
    """What a stop means for the next motion."""

    LATCH = "latched until re-armed"
    HOLD = "held for its run"
    PLAIN = "the end of a goal or of a run"


def commands(latched: bool) -> list[f.Effect]:
    """What stops a machine, whoever moves it; messages leave sooner than requests."""
    return [f.Zero(), *([f.Emergency(True)] if latched else []), f.CancelAll()]


def stop(
    gateway: Gateway, now: float, cause: Reason, kind: StopKind, *, run: int = 0, expected: Expected = NOTHING,
    broken: Reason | None = None,
) -> Stop:  # fmt: skip
    """Stop the machine, whoever moves it; `expected`: see `StandStill.proof`, worked out here from a goal under way."""
    active, latched = gateway.active, kind is StopKind.LATCH
    gateway.do(*commands(latched))
    if active is not None and active.sent and not active.outcome:
        gateway.do(f.Cancel(active.number))  # also a goal that the machine has not answered yet
    owner = active.owner if active is not None else None
    if latched:
        gateway.latch.close(cause)
        notes.keep(gateway)
    elif kind is StopKind.HOLD and owner is not None:
        gateway.latch.keep(cause, owner)
    goal, over = (active, now) if active is not None else gateway.last
    if goal is not None and goal.stop is None and now - over < gateway.watch.settles:
        expected = _expected(gateway, goal, over, now)
    elif not gateway.recovery.over:  # a motion that goes on may have begun before this gateway
        expected = UNKNOWN
    made = _begin(gateway, now, cause, latched, run or (owner.run if owner is not None else gateway.run or 0), expected)
    made.broken = broken
    if active is not None:
        active.stop = active.stop or made
    gateway.vigil.begin()
    gateway.do(f.Publish())
    return made


def _expected(gateway: Gateway, goal: Goal, over: float, now: float) -> Expected:
    """The motion that must be seen if a goal is stopped now, or was over a moment ago: its server may answer late."""
    if not goal.sent:
        return NOTHING
    if goal.follower is None:
        return Expected(goal.sent)
    since = goal.sent if goal.follower.should_have_moved(over - goal.sent) else None
    on_its_way = {} if goal.outcome == "SUCCEEDED" else goal.follower.on_its_way(now, gateway.watch.dead_times, over)
    return Expected(since, on_its_way, goal.follower.behind(over, now))


def _begin(gateway: Gateway, now: float, cause: Reason, latched: bool, run: int, expected: Expected) -> Stop:
    proof = gateway.watch.proof(now, latched, expected)
    under_way = [other for other in gateway.stops if other.receipt is None]
    for earlier in under_way:
        proof = proof.after(earlier.proof)
    if not under_way:
        gateway.watch.mark()
    gateway.numbered += 1
    made = Stop(gateway.numbered, cause, latched, run, gateway.active, now, now + gateway.wall, proof, now + AGAIN,
                now + STOP_PROVEN)  # fmt: skip
    gateway.stops.append(made)
    return made


def advance(gateway: Gateway, now: float) -> None:
    """Repeat the commands of stops that are not proven yet, and end those that are, or have taken too long."""
    for one in list(gateway.stops):
        if one.receipt is not None:
            if now >= one.limit + DISK_LIMIT and not one.over:
                late = replace(one.receipt, confirmed=False, latched=True, detail=r.NoEnd())
                _unproven(gateway, one, late)
                _over(gateway, one, late)
        elif _seen(gateway, one, now) or now >= one.limit:
            if not _released(gateway, one, now):
                _end(gateway, one, now)
        elif now > one.again:
            one.again = now + AGAIN
            gateway.do(*commands(one.latched))


def _seen(gateway: Gateway, one: Stop, now: float) -> bool:
    return one.ended() and gateway.watch.proven(one.proof, now)


def _released(gateway: Gateway, one: Stop, now: float) -> bool:
    """Release what the host agent has pressed, once the machine stands; whether it may jump and is watched anew."""
    latched, jumps = gateway.latch.cause is not None, gateway.facts.jumps
    if not gateway.stood_in or latched or not gateway.recovery.reached or not _seen(gateway, one, now):
        return False
    gateway.stood_in = False
    gateway.do(f.Emergency(False))
    for other in gateway.stops if jumps else ():
        other.proof, other.limit = other.proof.later(now + jumps), other.limit + jumps
    return jumps > 0.0


def _end(gateway: Gateway, one: Stop, now: float) -> None:
    """Note what a stop has shown, then keep its receipt."""
    receipt = one.receipt = _receipt(gateway, one, now)
    if not receipt.confirmed:
        _unproven(gateway, one, receipt)
    elif gateway.run is None:  # it stands, and no run's goal moves it
        notes.hold(gateway, "", 0)
    else:
        notes.keep(gateway)
    gateway.do(f.KeepReceipt(one.number, receipt))


def _unproven(gateway: Gateway, one: Stop, receipt: f.Receipt) -> None:
    gateway.latch.close(r.NotSeenToStand(one.cause, receipt.detail or r.NoEnd(), gateway.facts.name))
    gateway.do(f.Emergency(True), f.Publish())
    notes.keep(gateway)


def _receipt(gateway: Gateway, one: Stop, now: float) -> f.Receipt:
    seen, travel = _seen(gateway, one, now), gateway.watch.travel()
    obstacle = one.broken or (r.GoalOpen() if not one.ended() else gateway.watch.obstacle(now))
    confirmed, unstamped = seen and one.broken is None, gateway.watch.unstamped
    return f.Receipt(
        one.cause, one.stamp, one.run, one.latched or not confirmed, confirmed, now - one.begun, travel.joint,
        travel.angle, travel.way, None if confirmed else obstacle, r.ByArrival(tuple(unstamped)) if unstamped else None,
    )  # fmt: skip


def stood_after(seconds: float, joint: str, angle: float, way: float, cause: Reason) -> Reason:
    """How long it took until the machine stood, and how far it went; `joint` is empty if none was seen."""
    return r.Stood(seconds, angle, joint, way, cause) if joint else r.StoodWithoutJoints(seconds, way, cause)


def kept(gateway: Gateway, event: ReceiptKept) -> None:
    """A receipt is on the disk, or cannot be: it is told in any case, as a run must not wait for a full disk."""
    one = next((one for one in gateway.stops if one.number == event.stop), None)
    if one is None or one.receipt is None:
        return
    receipt = one.receipt
    if event.problem:
        known, lost = receipt.evidence, r.NotOnDisk(event.problem)
        receipt = replace(receipt, evidence=lost if known is None else Several((known, lost)))
    gateway.do(f.Tell(receipt))
    gateway.stops.remove(one)
    if not one.over:
        _over(gateway, one, receipt)


def _over(gateway: Gateway, one: Stop, receipt: f.Receipt) -> None:
    one.answer = receipt
    gateway.do(*(f.Stopped(request, receipt) for request in one.requests))
    for goal in gateway.waiting if one.requests and not one.latched else ():
        goal.cancelled |= goal.owner is not None  # the run has ended that asked for the stop


def busy(gateway: Gateway) -> bool:
    """Whether a stop is under way: its commands would end any motion that begins now."""
    return any(not one.over for one in gateway.stops)


def watch(gateway: Gateway, now: float) -> None:
    """See that a stopped machine still stands, also while the receipt of its goal's stop waits for the disk."""
    gateway.watch.settle(now)
    if (active := gateway.active) is not None and (active.stop is None or active.stop.receipt is None):
        gateway.watch.commanded(now)
    elif gateway.vigil.left(now, gateway.watch.moved_at) and gateway.by_hand is None and not gateway.proves():
        stop(gateway, now, r.LeftStandStill(), StopKind.LATCH, broken=r.LeftStandStill())
