"""What must hold at every moment, against the true motion of the machines."""

from simulation.site import Site
from simulation.unit import Unit
from simulation.world import Process, Violation
from tms_decision.run.step import TICK_LIMIT

STOP_IN_TIME = 1.3  # s from a loss until the machine must have been told to stop
FOUND = 3.0  # s for processes to find each other, on a busy PC
NOTED = 0.5  # s for a latch to be noted
ANSWERED = 12.0  # s in which every call is answered


def look(site: Site) -> None:
    """Raises Violation."""
    now = site.world.now
    for unit in site.units.values():
        _in_time(site, unit)
        _stood_in(site, unit)
        _answered(unit, now)
        _noted(unit, now)
    for run in site.scheduler.runs.values():
        run.in_time(now)


def _in_time(site: Site, unit: Unit) -> None:
    """A run's goal whose processes are lost does not move the machine for long while its gateway works."""
    gateway, plant = unit.gateway, unit.machine.plant
    if plant.goal is None or plant.fault.ignore_cancel or unit.owner is None or gateway.worked_for() < 3.0:
        return
    if unit.machine.ordered_to_stop >= unit.sent_at:
        return
    behind: list[Process] = [site.scheduler, *unit.relays.values()]
    for process in behind:
        if process.lost_for() > STOP_IN_TIME:
            raise Violation(f"{process.name} is lost for {process.lost_for():.1f} s, and {unit.name} moves on")
    hangs = [run.hangs for run in site.scheduler.runs.values() if run.number == unit.owner.run]
    hung = site.world.now - site.scheduler.hung_at
    if hangs and site.world.now < hangs[0] and hung > TICK_LIMIT + STOP_IN_TIME:
        raise Violation(f"the thread of {unit.owner} hangs for {hung:.1f} s, and {unit.name} moves on")


def _stood_in(site: Site, unit: Unit) -> None:
    """A machine whose gateway is lost does not move for long while its host agent works."""
    gateway, machine = unit.gateway, unit.machine
    young = gateway.lost_at - gateway.up_at < FOUND or site.host.worked_for() < FOUND + STOP_IN_TIME
    if gateway.lost_for() < STOP_IN_TIME or young or unit.second is not None:
        return
    if machine.plant.goal is not None and not machine.plant.fault.ignore_cancel and (
            machine.ordered_to_stop < gateway.lost_at):  # fmt: skip
        raise Violation(f"{gateway.name} is lost for {gateway.lost_for():.1f} s, and {unit.name} moves on")


def _noted(unit: Unit, now: float) -> None:
    """The disk knows of a latch, unless it stalls: else a successor would be armed."""
    for gateway in unit.gateways():
        notes = gateway.notes
        if gateway.noted() or not gateway.works():
            gateway.noted_at = now
        elif now - max(gateway.noted_at, notes.stalls, gateway.up_at) > NOTED:
            raise Violation(f"{gateway.name} is latched, and the disk does not know it")


def _answered(unit: Unit, now: float) -> None:
    """Whoever asks for a stop, a re-arm or a goal gets an answer, if the gateway works meanwhile."""
    for gateway in unit.gateways():
        for since, _ in gateway.calls.values():
            if now - max(since, gateway.up_at) > ANSWERED and gateway.worked_for() > ANSWERED:
                raise Violation(f"a call to {gateway.name} is not answered within {ANSWERED:.0f} s")
