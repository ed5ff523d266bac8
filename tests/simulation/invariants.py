"""What must hold at every moment, against the true motion of the machines."""

from simulation.execution import Execution
from simulation.plant import Fault
from simulation.site import Site
from simulation.unit import SUBTASK, Unit
from simulation.world import Process, Violation
from tms_decision.duty import HANDED_ON
from tms_decision.run.step import TICK_LIMIT, Phase

STOP_IN_TIME = 1.3  # s from a loss until the machine must have been told to stop
FOUND = 3.0  # s for processes to find each other, on a busy PC
NOTICED = 3.0  # s until a machine that lies must have been told to stop
GIVEN_UP = 6.0  # s until a run must know that a process is gone
NOTED = 0.5  # s for a latch to be noted
RECOVERED = 11.0  # s in which a new gateway has found the machine, and waited for a run to report itself
ANSWERED = 12.0  # s in which every call is answered


def look(site: Site) -> None:
    """Raises Violation."""
    now = site.world.now
    for unit in site.units.values():
        _in_time(site, unit)
        _stood_in(site, unit)
        _answered(unit, now)
        _noted(unit, now)
        _cancelled(unit, now)
        _left(unit, now)
        _believed(unit, now)
        _pressed(site, unit, now)
        _orphaned(unit, now)
    for run in site.scheduler.runs.values():
        run.in_time(now)
        _abandoned(site, run, now)


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
    met = max(gateway.up_at, site.host.up_at) + FOUND  # before that, the scheduler's stop is all that there is
    young = gateway.lost_at < met or site.host.worked_for() < FOUND + STOP_IN_TIME
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


def _cancelled(unit: Unit, now: float) -> None:
    """A goal that its client has cancelled does not move the machine for long."""
    gateway, machine = unit.gateway, unit.machine
    for number, since in gateway.cancelled.items():
        late = now - max(since, gateway.up_at) > STOP_IN_TIME and gateway.works()
        if late and machine.plant.goal == number and machine.ordered_to_stop < since:
            raise Violation(f"goal {number} is cancelled for {now - since:.1f} s, and {unit.name} moves on")


def _left(unit: Unit, now: float) -> None:
    """A latched machine that somebody moves is stopped again, if it tells the truth and nobody has taken it.

    A person who gives it back while its gateway is away has not given it back.
    """
    (begun, ends), core, plant = unit.levers, unit.gateway.core, unit.machine.plant
    unit.latched_since = unit.latched_since if core is not None and core.latch.cause is not None else now
    by_hand = unit.driven or (core is not None and core.by_hand is not None)
    unit.by_hand_at = now if by_hand else unit.by_hand_at
    begun = max(begun, unit.lies_since, unit.by_hand_at)
    if (
        not begun + STOP_IN_TIME < now < ends
        or unit.latched_since > begun
        or plant.speed == 0.0
        or plant.fault != Fault()
    ):
        return
    if unit.machine.ordered_to_stop < begun and unit.gateway.worked_for() > now - begun:
        raise Violation(f"{unit.name} is latched, moves, and nobody stops it")


def _believed(unit: Unit, now: float) -> None:
    """A machine that falls silent, or tells what cannot be, does not move on for long."""
    fault, plant, gateway = unit.machine.plant.fault, unit.machine.plant, unit.gateway
    lies = fault.mute or fault.second_publisher or fault.zero_velocity or (
        fault.mute_joint and plant.passive)  # fmt: skip
    since = max(unit.lies_since, unit.sent_at)
    if not lies or plant.goal is None or plant.speed == 0.0 or min(now - since, gateway.worked_for()) < NOTICED:
        return
    if unit.machine.ordered_to_stop < since:
        raise Violation(f"{unit.name} is {fault}, and moves on")


def _abandoned(site: Site, run: Execution, now: float) -> None:
    """A run does not wait for the answer of a process that is gone."""
    for unit, _, life, key in run.orders.values() if run.core.phase is Phase.RUNNING else ():
        relay = unit.relays[SUBTASK]
        waits = min(relay.worked_for(), site.host.worked_for(), site.scheduler.worked_for(), now - run.hangs)
        if relay.life != life and waits > GIVEN_UP:
            raise Violation(f"{run.run_id} waits for {key}, whose process is gone for {waits:.1f} s")


def _pressed(site: Site, unit: Unit, now: float) -> None:
    """A press that the gateway was away for is handed on to its successor."""
    gateway = unit.gateway
    if gateway.core is not None and gateway.core.latch.cause is not None:
        unit.missed = float("inf")
    since = max(unit.missed, gateway.up_at)
    if now - since > HANDED_ON + FOUND and min(gateway.worked_for(), site.host.worked_for() - now + unit.missed) > 0.0:
        raise Violation(f"the stop button was pressed without {gateway.name}, which does not know it")


def _orphaned(unit: Unit, now: float) -> None:
    """A machine whose scheduler was killed during a run is latched; a gateway that was frozen may not notice."""
    gateway, orphan = unit.gateway, unit.orphan
    core = gateway.core
    if orphan is None or core is None:
        return
    if core.latch.cause is not None or gateway.frozen() or unit.second is not None:
        unit.orphan = None
        return
    waits = now - orphan.since
    heard = gateway.life == orphan.life and min(orphan.knew, gateway.worked_for() - waits) > FOUND
    late = waits > STOP_IN_TIME if heard else gateway.worked_for() > RECOVERED
    if late or core.run not in (None, orphan.run):
        raise Violation(f"the scheduler of {unit.name} is lost for {waits:.1f} s, and it is not latched")


def _answered(unit: Unit, now: float) -> None:
    """Whoever asks for a stop, a re-arm or a goal gets an answer, if the gateway works meanwhile."""
    for gateway in unit.gateways():
        for since, _ in gateway.calls.values():
            if now - max(since, gateway.up_at) > ANSWERED and gateway.worked_for() > ANSWERED:
                raise Violation(f"a call to {gateway.name} is not answered within {ANSWERED:.0f} s")
