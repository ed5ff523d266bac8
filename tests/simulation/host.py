"""The host agent: it stops machines in place of lost gateways, and tells which processes run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simulation.gateway import State
from simulation.world import Process
from tms_decision.duty import Act, Duty, GatewayStatus, Press
from tms_decision.gateway import events as e
from tms_decision.permit_link import NOBODY, PermitLink
from tms_decision.reasons import SoftwareStop

if TYPE_CHECKING:
    from simulation.unit import Unit

BEAT = 0.05  # s
NOTICED = (0.05, 0.3, 1.0, 3.0)  # s until others know of a process that has ended, or was started
TOGETHER = 1.0  # s between the losses of scheduler and gateway within which they count as one


class Standby:
    """The standby of one machine's gateway, in one life of the host agent."""

    def __init__(self, host: HostAgent, unit: Unit) -> None:
        self._host, self._unit = host, unit
        self._duty, self._gateway, self._scheduler = Duty(), PermitLink("rc"), PermitLink("ts")
        self._held_at, self.press = float("-inf"), Press()
        self._latched = False  # as the gateway has shown since the last beat
        self._reported = self._acts = False
        self._state: State | None = None
        world = host.world
        for link, name in ((self._gateway, "rc"), (self._scheduler, "ts")):
            unit.permits[name].join(
                f"host{host.life}",
                host.in_life(lambda goal, holder, link=link: link.heard(goal, holder, world.now)),
                host.in_life(lambda alive, stale, link=link: link.reported(alive, stale, False, world.now)),
            )
        unit.hear_state("host", host.in_life(self._received))
        unit.stands_in(False)

    def _received(self, state: State) -> None:
        self._reported, self._latched = True, state.latch is not None
        if self._duty.lost_since is None:
            self._state = state

    def beat(self, now: float) -> None:
        """Command what is due."""
        if self.press.due(now, alone(self._gateway, now), self._latched if self._reported else None):
            self._host.world.tell("tms:host", f"hands a press on to {self._unit.name}:rc")
            self._host.world.send(f"{self._unit.name} calls", lambda: self._unit.gateway.call(press, lambda _: None))
        act = self._duty.check(now, self._status(now))
        self._reported = False
        if act is not None:
            self._command(act)
        elif self._acts and self._duty.lost_since is None:
            self._acts = False
            self._unit.stands_in(False)

    def _status(self, now: float) -> GatewayStatus:
        gateway, scheduler, state = self._gateway, self._scheduler, self._state
        if scheduler.alive(now):
            self._held_at = now
        lost = scheduler.goal != NOBODY and not scheduler.alive(now) and now - self._held_at < TOGETHER
        return GatewayStatus(gateway.alive(now), gateway.left, self._reported, state is None or state.busy, lost)

    def _command(self, act: Act) -> None:
        unit, send = self._unit, self._host.world.send
        self._host.world.tell("tms:host", f"stands in for {unit.name}:rc: {act.value}")
        send(f"{unit.name} zero2", unit.machine.zero)
        if act is Act.EMERGENCY:
            send(f"{unit.name} emergency2", lambda: unit.machine.emergency(True))
            unit.to_gateway("stood_in", e.StoodIn())
        send(f"{unit.name} cancel2", unit.machine.cancel)
        if self._duty.lost_since is not None:
            self._acts = True
            unit.stands_in(True)


def alone(gateway: PermitLink, now: float) -> bool:
    """Whether one gateway lives: of two, nobody knows which shows its latch."""
    return gateway.alive(now) and gateway.asserted < 2


def press(number: int) -> e.Event:
    """What a gateway is asked that does not know of a press."""
    return e.StopAsked(number, SoftwareStop(), False)


class HostAgent(Process):
    """One PC with all machines' processes."""

    def __init__(self, units: list[Unit]) -> None:
        super().__init__(units[0].world, "tms:host")
        self._units = units
        self._standbys: list[Standby] = []

    def start(self) -> None:
        self.begin()
        self._standbys = [Standby(self, unit) for unit in self._units]
        for unit in self._units:
            for name in unit.relays:
                self.noticed(unit, name)
        self._beat()

    def pressed(self) -> None:
        """The stop button is pressed."""
        life = self.life
        for standby in self._standbys:
            standby.press.since = self.world.now
        for unit in self._units:
            unit.gateway.notes.press(lambda: self.works() and self.life == life)

    def noticed(self, unit: Unit, name: str) -> None:
        """A process was started or has ended: who looks gets to know it a moment later."""
        self.later(self.world.random.choice(NOTICED), lambda: unit.process_seen(name))

    def _beat(self) -> None:
        for standby in self._standbys:
            standby.beat(self.world.now)
        self.later(BEAT * (1.0 + self.world.random.random()), self._beat)
