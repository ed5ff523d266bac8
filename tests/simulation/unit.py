"""A machine with the processes that belong to it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING

from simulation.disk import Notes
from simulation.gateway import GatewayProcess, State
from simulation.lease import Topic
from simulation.machine import Machine
from simulation.relay import Relay, Server
from simulation.world import World
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.owner import Owner

if TYPE_CHECKING:
    from simulation.host import HostAgent

SUBTASK, PLANNER = "swing", "rp"


class Trap:
    """Does something at the moment of the next effect of a kind."""

    def __init__(self) -> None:
        self._waits: dict[str, Callable[[], None]] = {}

    def set(self, kind: str, step: Callable[[], None]) -> None:
        """`kind`: name of the class of the effect."""
        self._waits[kind] = step

    def sprung(self, kind: str) -> None:
        """An effect of this kind was done."""
        step = self._waits.pop(kind, None) if self._waits else None
        if step is not None:
            step()


@dataclass(frozen=True)
class Orphan:
    """A machine whose scheduler was killed during a run."""

    run: int
    since: float
    life: int  # of its gateway
    knew: float  # s for which that had worked


def _nobody_checks(unit: Unit, owner: Owner | None) -> None:
    """Before the site is complete."""


class Unit:
    """One machine."""

    def __init__(
        self, world: World, name: str, numbers: count[int], *, at_once: bool, planner: bool, passive: bool = False
    ) -> None:
        self.world, self.name, self._numbers = world, name, numbers
        self.wall = 1e9  # s since 1970 of its PC, less virtual time
        names = ["ts", "rc", SUBTASK, *([PLANNER] if planner else [])]
        self.permits = {one: Topic(world, f"{name}/{one}") for one in names}
        self.machine = Machine(world, name, at_once, passive)
        self.gateway = GatewayProcess(self, f"{name}:rc", Notes(world))
        self.second: GatewayProcess | None = None
        self.relays = {SUBTASK: Relay(self, SUBTASK, PLANNER if planner else "rc")}
        if planner:
            self.relays[PLANNER] = Relay(self, PLANNER, "rc")
        self.host: HostAgent | None = None
        self.pids: dict[str, int] = {}  # of the relays, as the host agent has told them
        self._uptimes: dict[str, float] = {}  # s, with them
        self.sent_at = float("-inf")  # when the last goal left for the machine ...
        self.owner: Owner | None = None  # ... and whose it was
        self.goals = 0  # sent
        self.driven = False  # a person has taken it
        self.missed = float("inf")  # when a press came that its gateway has not heard
        self.latched_since = 0.0
        self.by_hand_at = float("-inf")  # when a person last had it
        self.lies_since = 0.0  # when it last became unkind, or kind again
        self.orphan: Orphan | None = None  # while the scheduler of its run is lost, and it is not latched yet
        self.replayed_at = float("-inf")  # when it last ended to tell its past for its present
        self.levers = 0.0, 0.0  # when somebody moves it by its levers without a word, from and to
        self.receipts: list[f.Receipt] = []
        self.trap = Trap()
        self.check_owner = _nobody_checks
        self.hears_receipts: dict[str, Callable[[f.Receipt], None]] = {}
        self._state: State | None = None
        self._hear_state: dict[str, Callable[[State], None]] = {}
        self._stands_in: bool | None = None

    def number(self) -> int:
        return next(self._numbers)

    def start(self) -> None:
        """Everything starts; the machine is armed."""
        self.gateway.notes.armed = True
        self.gateway.start()
        for relay in self.relays.values():
            relay.begin()

    def server(self, permit: str) -> Server:
        """The process with this permit."""
        return self.gateway if permit == "rc" else self.relays[permit]

    def gateways(self) -> list[GatewayProcess]:
        return [self.gateway, *([self.second] if self.second is not None else [])]

    # topics

    def published(self, state: State) -> None:
        """A gateway has published the state; the topic is latched."""
        self._state = state
        for name, hear in self._hear_state.items():
            self.world.send(f"{self.name}/state/{name}", lambda hear=hear: hear(state))  # type: ignore[misc]

    def hear_state(self, name: str, hear: Callable[[State], None]) -> None:
        """Hear the state from now on, the last one first."""
        self._hear_state[name] = hear
        if self._state is not None:
            state = self._state
            self.world.after(0.1, lambda: hear(state))

    def told(self, receipt: f.Receipt) -> None:
        """A gateway has told a receipt."""
        self.receipts.append(receipt)
        for name, hear in self.hears_receipts.items():
            self.world.send(f"{self.name}/receipts/{name}", lambda hear=hear: hear(receipt))  # type: ignore[misc]

    def to_gateway(self, topic: str, event: e.Event) -> None:
        """A message for the gateway."""
        for gateway in self.gateways():
            self.world.send(f"{self.name}/{topic}", lambda gateway=gateway: gateway.happens(event))  # type: ignore[misc]

    def stands_in(self, on: bool) -> None:
        """The host agent says whether it commands the machine; the topic is latched."""
        self._stands_in = on
        self.to_gateway("standby", e.StandsIn(on))

    def standby_joins(self, gateway: GatewayProcess) -> None:
        """A gateway hears the host agent's last word, if that lives."""
        host, said = self.host, self._stands_in
        if host is not None and host.alive and said is not None:
            gateway.later(0.1, lambda: gateway.happens(e.StandsIn(said)))

    def process_seen(self, name: str) -> None:
        """The host agent tells which process a relay is."""
        relay = self.relays[name]
        self.pids[name] = relay.life if relay.alive else 0
        self._uptimes[name] = math.floor(self.world.now) - math.floor(relay.begun_at)

    def age(self, name: str) -> float:
        """Seconds for which a relay has run at least, by the host agent's last word: whole seconds of two clocks."""
        return max(0.0, self._uptimes.get(name, 0.0) - 1.0)

    # what leaves

    def leaves(self, owner: Owner | None) -> None:
        """A goal leaves for the machine."""
        self.sent_at, self.owner = self.world.now, owner
        self.goals += 1
