"""The permits of the processes that stand behind goals, and the run that holds the machine."""

from tms_decision.gateway import goals, motion, notes, recovery, stops
from tms_decision.gateway.events import PermitHeard, PermitReported
from tms_decision.gateway.state import SCHEDULER, Gateway
from tms_decision.gateway.stops import StopKind
from tms_decision.permit_link import NOBODY, PermitLink
from tms_decision.reasons import SchedulerLost


def heard(gateway: Gateway, now: float, event: PermitHeard) -> None:
    """Take a message of a process."""
    link = gateway.links[event.process]
    link.heard(event.goal, event.holder, now)
    _changed(gateway, now, link)


def reported(gateway: Gateway, now: float, event: PermitReported) -> None:
    """Take a report of DDS."""
    link = gateway.links[event.process]
    link.reported(event.alive, event.not_alive, event.late, now)
    if link.doubted is None:
        _changed(gateway, now, link)


def advance(gateway: Gateway, now: float) -> None:
    """Judge doubted processes, and those whose message has become too old."""
    for link in gateway.links.values():
        if link.judge(now):
            _changed(gateway, now, link)
    motion.check_chain(gateway, now)


def _changed(gateway: Gateway, now: float, link: PermitLink) -> None:
    if link.process == SCHEDULER:
        _scheduler_changed(gateway, now, link)
    motion.check_chain(gateway, now)
    goals.admit(gateway, now)


def _scheduler_changed(gateway: Gateway, now: float, link: PermitLink) -> None:
    run = gateway.held(now).get(SCHEDULER)
    if run is None and gateway.run is not None and link.goal != NOBODY:
        lost, gateway.run = gateway.run, None
        gateway.latch.run_lost()
        stops.stop(gateway, now, SchedulerLost(), StopKind.LATCH, run=lost)
        return
    before, gateway.run = gateway.run, None if run is None else run.run
    gateway.latch.run_is(gateway.run)
    if gateway.run is not None:
        recovery.claimed(gateway, now, gateway.run)
    elif before is not None:
        notes.hold(gateway, "", 0)
