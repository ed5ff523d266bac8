"""The gateway's one function: something happens, and it decides."""

from collections.abc import Callable, Iterable
from typing import Any

from tms_decision import reasons as r
from tms_decision.gateway import active, arming, goals, motion, notes, permits, presses, recovery, stops
from tms_decision.gateway import events as e
from tms_decision.gateway.effects import Effect, Publish
from tms_decision.gateway.state import SCHEDULER, Gateway, Notes, Recovery
from tms_decision.gateway.stops import StopKind
from tms_decision.latch import Latch
from tms_decision.permit_link import PermitLink
from tms_proof.facts import MachineFacts
from tms_proof.standstill import StandStill
from tms_reason.reason import Foreign, Reason

MOVING_PERIOD, STILL_PERIOD = 0.2, 0.5  # s between messages about the machine; a change is published at once


def start(
    facts: MachineFacts, process: str, names: Iterable[str], left: e.Left, now: float, wall: float
) -> tuple[Gateway, list[Effect]]:
    """A gateway at its start, and its first effects; `names`: the processes whose permits it hears."""
    cause: Reason = r.GatewayRestarted(process)
    if left.holder:
        cause = r.GatewayRestartedHeld(process, left.holder)
    if left.unproven:
        cause = r.GatewayRestartedUnproven(process)
    gateway = Gateway(
        facts, StandStill(facts), Latch(facts.name, left.latched), notes=Notes(left.holder, left.run),
        links={name: PermitLink(name) for name in (SCHEDULER, *names)},
        recovery=Recovery(r.ProcessLost(cause), left.holder, left.run, left.unproven, now),
    )  # fmt: skip
    gateway.wall, gateway.standby = wall - now, now + presses.STANDBY
    gateway.recovering = bool(left.holder)
    gateway.by_hand = Foreign(left.taken) if left.taken else None
    if left.latched is not None:
        gateway.vigil.begin()
    recovery.begin(gateway)
    return gateway, _taken(gateway)


def step(gateway: Gateway, event: e.Event, now: float) -> list[Effect]:
    """Let something happen; returns what is to be done, in this order."""
    STEPS[type(event)](gateway, now, event)
    return _taken(gateway)


def _taken(gateway: Gateway) -> list[Effect]:
    out, gateway.out = gateway.out, []
    return out


def _stop(gateway: Gateway, now: float, event: e.StopAsked) -> None:
    """Stop the machine, also a motion of a foreign client; the answer is the receipt."""
    cause = event.cause or r.SoftwareStop()
    if not event.orderly and cause.find(r.SoftwareStop) is None:
        cause = r.SoftwareStopSaying(cause)
    made = stops.stop(gateway, now, cause, StopKind.PLAIN if event.orderly else StopKind.LATCH)
    made.requests.append(event.request)


def _note_kept(gateway: Gateway, now: float, event: e.NoteKept) -> None:
    notes.kept(gateway, event)
    active.noted(gateway, now, event)
    arming.noted(gateway, now, event)


def _receipt_kept(gateway: Gateway, now: float, event: e.ReceiptKept) -> None:
    stops.kept(gateway, event)
    recovery.advance(gateway, now)
    active.go_on(gateway, now)
    goals.admit(gateway, now)


def _beat(gateway: Gateway, now: float, beat: e.Beat) -> None:
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


STEPS: dict[type[e.Event], Callable[[Gateway, float, Any], None]] = {
    e.Beat: _beat, e.StopAsked: _stop, e.NoteKept: _note_kept, e.ReceiptKept: _receipt_kept,
    e.PermitHeard: permits.heard, e.PermitReported: permits.reported, e.GoalAsked: goals.ask, e.CallEnded: active.ended,
    e.Signal: presses.signal, e.RearmAsked: arming.ask, e.TakeAsked: arming.take, e.Manual: arming.manual,
    e.Sampled: lambda gateway, now, event: gateway.watch.take(event.source, event.sample),
    e.Published: lambda gateway, now, event: gateway.watch.published(event.source, event.nodes),
    e.GoalCancelled: lambda gateway, now, event: goals.cancel(gateway, now, event.number),
    e.CallAccepted: lambda gateway, now, event: active.accepted(gateway, now, event.number),
    e.Pressed: lambda gateway, now, event: presses.pressed(gateway, now),
    e.StoodIn: lambda gateway, now, event: presses.stood_in(gateway, now),
    e.StandsIn: presses.stands_in, e.Leaving: lambda gateway, now, event: gateway.leave(),
}  # fmt: skip
