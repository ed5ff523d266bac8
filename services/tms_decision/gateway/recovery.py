"""The start of a gateway: the last one may have left the machine moving, so it is stopped and held or latched."""

from tms_decision.gateway import stops
from tms_decision.gateway.state import Gateway
from tms_decision.gateway.stops import StopKind
from tms_decision.latch import ANY_LEAF, UNKNOWN_RUN
from tms_decision.owner import Owner
from tms_decision.reasons import NoRunTold, TakenByAnother
from tms_proof.proof import UNKNOWN

REACHED = 5.0  # s for the machine's servers to be there
LEFT_MOVING = 2.0  # s that a machine that was left armed and idle is watched for a motion
RUN_KNOWN_LIMIT = 3.0  # s in which the run of a stopped machine must report itself, else the machine is latched


def begin(gateway: Gateway) -> None:
    """Cancel all goals of the machine: those that the last gateway has left."""
    gateway.do(*stops.commands(gateway.latch.cause is not None))


def advance(gateway: Gateway, now: float) -> None:
    """Stop the machine if a run held it, or if it moves; latch it if no run reports itself."""
    recovery = gateway.recovery
    if recovery.over:
        return
    if not recovery.reached:
        _reach(gateway, now)
    elif recovery.open and gateway.active is None and now < recovery.until:
        if recovery.stop is None and gateway.watch.moved_at > recovery.begun:
            recovery.until = now + RUN_KNOWN_LIMIT
            _take_over(gateway, now, UNKNOWN_RUN)
    else:
        _close(gateway, now)
        recovery.over = recovery.stop is None or recovery.stop.over
        gateway.recovering = gateway.recovering and not recovery.over


def _reach(gateway: Gateway, now: float) -> None:
    recovery = gateway.recovery
    if not gateway.beat.reachable and now - recovery.begun < REACHED:
        return
    recovery.reached = True
    gateway.do(*stops.commands(gateway.latch.cause is not None))
    if recovery.holder or recovery.unproven:
        _take_over(gateway, now, recovery.run or UNKNOWN_RUN)
    recovery.until = now + (RUN_KNOWN_LIMIT if recovery.holder else LEFT_MOVING)


def claimed(gateway: Gateway, now: float, run: int) -> None:
    """Hold the machine for a run that its scheduler reports, if the machine may have been left moving."""
    recovery = gateway.recovery
    if not recovery.open or gateway.active is not None:
        return
    recovery.open = False
    if recovery.run and run != recovery.run:
        stops.stop(gateway, now, TakenByAnother(recovery.cause), StopKind.LATCH, run=recovery.run)
        return
    gateway.latch.keep(recovery.cause, Owner(run, ANY_LEAF))
    if recovery.stop is None or recovery.stop.run != run:
        _begin(gateway, now, run)


def _take_over(gateway: Gateway, now: float, run: int) -> None:
    if gateway.recovery.open and gateway.active is None:
        gateway.recovering = True
        gateway.latch.keep(gateway.recovery.cause, Owner(run, ANY_LEAF))
        _begin(gateway, now, run)


def _begin(gateway: Gateway, now: float, run: int) -> None:
    cause, number = gateway.recovery.cause, 0 if run == UNKNOWN_RUN else run
    gateway.recovery.stop = stops.stop(gateway, now, cause, StopKind.PLAIN, run=number, expected=UNKNOWN)


def _close(gateway: Gateway, now: float) -> None:
    """End the wait for a run; latch if a motion was stopped and no run has reported itself."""
    recovery = gateway.recovery
    if recovery.open and recovery.stop is not None and gateway.latch.cause is None and gateway.active is None:
        stops.stop(gateway, now, NoRunTold(recovery.cause), StopKind.LATCH, run=recovery.run, expected=UNKNOWN)
    recovery.open = False
