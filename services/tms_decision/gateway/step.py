"""The gateway's one function: something happens, and it decides."""

from collections.abc import Iterable

from tms_decision.gateway import active, arming, goals, motion, notes, permits, presses, recovery, stops
from tms_decision.gateway import events as e
from tms_decision.gateway.effects import Effect, Publish
from tms_decision.gateway.state import SCHEDULER, Gateway, Recovery
from tms_decision.gateway.stops import StopKind
from tms_decision.latch import Latch
from tms_decision.permit_link import PermitLink
from tms_decision.reasons import (
    GatewayRestarted,
    GatewayRestartedHeld,
    GatewayRestartedUnproven,
    ProcessLost,
    SoftwareStop,
    SoftwareStopSaying,
)
from tms_proof.facts import MachineFacts
from tms_proof.standstill import StandStill
from tms_reason.reason import Foreign, Reason

MOVING_PERIOD, STILL_PERIOD = 0.2, 0.5  # s between messages about the machine; a change is published at once


def start(
    facts: MachineFacts, process: str, names: Iterable[str], left: e.Left, now: float, wall: float
) -> tuple[Gateway, list[Effect]]:
    """A gateway at its start, and its first effects; `names`: the processes whose permits it hears."""
    cause: Reason = GatewayRestarted(process)
    if left.holder:
        cause = GatewayRestartedHeld(process, left.holder)
    if left.unproven:
        cause = GatewayRestartedUnproven(process)
    gateway = Gateway(
        facts, StandStill(facts), Latch(facts.name, left.latched),
        {name: PermitLink(name) for name in (SCHEDULER, *names)},
        Recovery(ProcessLost(cause), left.holder, left.run, left.unproven, now),
    )  # fmt: skip
    gateway.wall = wall - now
    gateway.recovering = bool(left.holder)
    gateway.by_hand = Foreign(left.taken) if left.taken else None
    if left.latched is not None:
        gateway.vigil.begin()
    recovery.begin(gateway)
    return gateway, _taken(gateway)


def step(gateway: Gateway, event: e.Event, now: float) -> list[Effect]:
    """Let something happen; returns what is to be done, in this order."""
    _happened(gateway, event, now)
    return _taken(gateway)


def _taken(gateway: Gateway) -> list[Effect]:
    out, gateway.out = gateway.out, []
    return out


def _happened(gateway: Gateway, event: e.Event, now: float) -> None:
    match event:
        case e.Beat():
            _beat(gateway, event, now)
        case e.Sampled(source, sample):
            gateway.watch.take(source, sample)
        case e.Published(source, nodes):
            gateway.watch.sources[source].publishers = nodes
        case e.PermitHeard():
            permits.heard(gateway, now, event)
        case e.PermitReported():
            permits.reported(gateway, now, event)
        case e.GoalAsked():
            goals.ask(gateway, now, event)
        case e.GoalCancelled(number):
            goals.cancel(gateway, now, number)
        case e.CallAccepted(number):
            active.accepted(gateway, now, number)
        case e.CallEnded():
            active.ended(gateway, now, event)
        case e.NoteKept() | e.ReceiptKept():
            _kept(gateway, event, now)
        case _:
            _asked(gateway, event, now)


def _asked(gateway: Gateway, event: e.Event, now: float) -> None:
    """Something that people do, or that is done for them."""
    match event:
        case e.Signal():
            presses.signal(gateway, now, event)
        case e.Pressed():
            presses.pressed(gateway, now)
        case e.StoodIn():
            presses.stood_in(gateway, now)
        case e.StopAsked():
            _stop(gateway, event, now)
        case e.RearmAsked():
            arming.ask(gateway, now, event)
        case e.TakeAsked():
            arming.take(gateway, now, event)
        case e.Manual():
            arming.manual(gateway, now, event)
        case e.Leaving():
            gateway.leaving = True


def _stop(gateway: Gateway, event: e.StopAsked, now: float) -> None:
    """Stop the machine, also a motion of a foreign client; the answer is the receipt."""
    cause = event.cause or SoftwareStop()
    if not event.orderly and cause.find(SoftwareStop) is None:
        cause = SoftwareStopSaying(cause)
    made = stops.stop(gateway, now, cause, StopKind.PLAIN if event.orderly else StopKind.LATCH)
    made.requests.append(event.request)


def _kept(gateway: Gateway, event: e.NoteKept | e.ReceiptKept, now: float) -> None:
    if isinstance(event, e.NoteKept):
        notes.kept(gateway, event)
        active.noted(gateway, now, event)
        arming.noted(gateway, now, event)
    else:
        stops.kept(gateway, event)
        recovery.advance(gateway, now)
        active.go_on(gateway, now)
        goals.admit(gateway, now)


def _beat(gateway: Gateway, beat: e.Beat, now: float) -> None:
    gateway.beats += 1
    since, gateway.beat, gateway.beat_at, gateway.wall = gateway.beat_at, beat, now, beat.wall - now
    permits.advance(gateway, now)
    presses.advance(gateway, now)
    motion.watch(gateway, now, since)
    stops.watch(gateway, now)
    stops.advance(gateway, now)
    recovery.advance(gateway, now)
    arming.advance(gateway, now)
    active.go_on(gateway, now)
    goals.admit(gateway, now)
    _show(gateway, now)


def _show(gateway: Gateway, now: float) -> None:
    """Publish the state at a beat if it has changed or the period is over."""
    moving, latch, goal = gateway.watch.moving(), gateway.latch, gateway.active
    shown = (moving, goal and goal.number, latch.cause, latch.hold, gateway.holder(now), gateway.by_hand)
    period = MOVING_PERIOD if moving or goal is not None else STILL_PERIOD
    if shown != gateway.shown or now - gateway.shown_at >= period:
        gateway.shown, gateway.shown_at = shown, now
        gateway.do(Publish())
