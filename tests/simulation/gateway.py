"""A gateway's decisions in a process that may be killed or frozen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simulation.disk import WRITTEN, Notes
from simulation.lease import PermitProcess, Topic
from simulation.machine import SPEED
from simulation.order import Order
from simulation.plant import JOINT, facts
from simulation.world import Process, Violation
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.gateway.state import Gateway
from tms_decision.gateway.step import start, step
from tms_proof.source import SourceSample
from tms_proof.standstill import JOINTS
from tms_reason.reason import Reason

if TYPE_CHECKING:
    from simulation.unit import Unit

BEAT, PROOF_BEAT = 0.05, 0.025  # s, at least; at most twice as much
SERVES = bytes([255]) * 16  # what its permit says
UNSEEN = 0.3  # s in which nobody can have seen that a motion has begun
SETTLES = 0.5  # s in which a machine takes the commands of a stop


@dataclass(frozen=True)
class State:
    """What a gateway publishes of its machine."""

    latch: Reason | None
    hold: Reason | None
    by_hand: Reason | None
    ready: bool
    busy: bool  # it moves, or has a goal or a run


class GatewayProcess(PermitProcess):
    """One gateway; a machine may have a second one by mistake."""

    def __init__(self, unit: Unit, name: str, notes: Notes) -> None:
        super().__init__(unit.world, name, {unit.name: unit.permits["rc"]})
        self.unit, self.notes = unit, notes
        self.core: Gateway | None = None
        self.asked: dict[int, Order] = {}
        self.calls: dict[int, tuple[float, Callable[[f.Effect], None]]] = {}
        self.latched = False  # a person has pressed stop, and nobody has armed since: no goal may leave
        self.pressed_at = float("-inf")  # when it last heard the button
        self.heard_with: list[tuple[Process, int]] = []  # who heard that, in which life
        self.noted_at = 0.0  # when the disk last knew of every latch
        self.cancelled: dict[int, float] = {}  # goals whose client has cancelled them, and when
        self._kept: set[float] = set()  # receipts that the disk has answered, by their stamps
        self._settles = float("-inf")  # when the last command of a stop left

    def start(self) -> None:
        self.begin()
        self.asked, self.calls, self.cancelled, self._kept = {}, {}, {}, set()
        self.notes.rearming = False
        unit, now = self.unit, self.world.now
        names = [name for name in unit.permits if name not in ("rc", "ts")]
        machine = unit.machine
        cores = start(
            facts(unit.name, machine.plant.at_once, machine.plant.passive),
            self.name,
            names,
            self.notes.left(),
            now,
            self._wall(),
        )
        self.core, effects = cores
        self._do(effects)
        if not self.alive:
            return  # killed at once
        machine.hears[self.name] = self._sampled
        machine.presses[self.name] = lambda: self.happens(e.Pressed())
        for name, topic in unit.permits.items():
            if name != "rc":
                self._hear(name, topic)
        unit.standby_joins(self)
        self.later(0.5, lambda: self.permits[unit.name].hold(SERVES))
        self._beat()

    def _hear(self, name: str, topic: Topic) -> None:
        topic.join(
            f"{self.name}{self.life}",
            self.in_life(lambda goal, holder: self._happens(e.PermitHeard(name, goal, holder))),
            self.in_life(lambda alive, stale: self._happens(e.PermitReported(name, alive, stale, False))),
        )

    def kill(self) -> None:
        super().kill()
        self._gone()

    def end(self) -> None:
        """End in order: its machine is stopped by the host agent."""
        super().end()
        self._gone()

    def _gone(self) -> None:
        self.core = None
        self.unit.machine.hears.pop(self.name, None)
        self.unit.machine.presses.pop(self.name, None)

    def noted(self) -> bool:
        """Whether the disk knows of a latch."""
        return self.core is None or self.core.latch.cause is None or not self.notes.armed

    def _wall(self) -> float:
        return self.unit.wall + self.world.now

    def _beat(self) -> None:
        core = self.core
        assert core is not None
        self._look()
        period = PROOF_BEAT if core.proves() else BEAT
        self.later(period * (1.0 + self.world.random.random()), self._beat)

    def _look(self) -> None:
        self._happens(e.Beat(self._wall(), settling=self.world.now - self._settles < SETTLES))

    def _sampled(self, sample: SourceSample) -> None:
        """The middleware stamps the arrival, also while the process is frozen."""
        now = self.world.now
        taken = SourceSample(now, sample.stamp, sample.number, sample.places, sample.speeds)
        self.handle(lambda: self._happens(e.Sampled(JOINTS, taken)))

    def happens(self, event: e.Event) -> None:
        """Something happens to the process, if it lives."""
        self.handle(lambda: self._happens(event))

    def _happens(self, event: e.Event) -> None:
        core = self.core
        if core is not None:
            self.notes.rearming = self.notes.rearming or (isinstance(event, e.RearmAsked) and bool(event.token))
            effects = step(core, event, self.world.now)
            if effects:
                self._do(effects)

    # who asks

    def ask(self, order: Order) -> None:
        """A client's goal arrives."""
        self.handle(lambda: self._ask(order))

    def _ask(self, order: Order) -> None:
        core = self.core
        assert core is not None
        number = self.unit.number()
        self.asked[number] = order
        order.at_server = number
        angle = core.watch.positions.get(JOINT, 0.0)
        way = e.Reference((JOINT,), [(at, (angle + SPEED * at,)) for at in (0.1, order.seconds)])
        self.world.tell(self.name, f"is asked for goal {number} of {order.owner}")
        order.accept()
        self._happens(e.GoalAsked(number, f"goal {number}", order.owner, "controller", motion=way, lasts=order.seconds))

    def cancel(self, order: Order) -> None:
        """A client cancels its goal."""
        self.handle(lambda: self._cancel(order.at_server))

    def _cancel(self, number: int) -> None:
        if number in self.asked:
            self.cancelled.setdefault(number, self.world.now)
            self._happens(e.GoalCancelled(number))

    def call(self, event: Callable[[int], e.Event], answer: Callable[[f.Effect], None]) -> None:
        """A service call arrives."""

        def take() -> None:
            number = self.unit.number()
            self.calls[number] = self.world.now, answer
            self._happens(event(number))

        self.handle(take)

    # effects

    def _do(self, effects: list[f.Effect]) -> None:
        life = self.life
        if any(isinstance(effect, f.Rearmed) and effect.armed for effect in effects):
            self.latched = self.notes.latch_told = False
            self.unit.missed, self.unit.orphan = float("inf"), None
            if not (self.notes.armed or self.notes.pressed):
                raise Violation(f"{self.name} is armed, and the disk does not say so")
        for effect in effects:
            self._one(effect)
            self.unit.trap.sprung(type(effect).__name__)
            if not self.alive or self.life != life:
                return  # killed at this moment

    def _one(self, effect: f.Effect) -> None:
        machine, send, name = self.unit.machine, self.world.send, self.name
        match effect:
            case f.Zero():
                send(f"{name} zero", machine.zero)
            case f.Emergency(on):
                self._settles = float("-inf") if on else self.world.now
                send(f"{name} emergency", lambda: machine.emergency(on))
            case f.CancelAll():
                self._settles = self.world.now
                send(f"{name} cancel", machine.cancel)
            case f.Cancel() | f.Lose() | f.GiveUp():
                send(f"{name} cancel", machine.cancel)
            case f.Send(number):
                self._send(number)
            case f.End(number):
                self._end(effect)
            case f.Stopped(request) | f.Rearmed(request) | f.Taken(request):
                self._answer(request, effect)
            case f.KeepState() | f.KeepDriver() | f.KeepReceipt():
                self._keep(effect)
            case _:
                self._tell(effect)

    def _tell(self, effect: f.Effect) -> None:
        match effect:
            case f.Look():
                self._look()
            case f.Publish():
                self._publish()
            case f.Tell(receipt):
                if receipt.stamp not in self._kept:
                    raise Violation(f"a receipt is told before the disk has answered: {receipt.cause!r}")
                self.world.tell(self.name, f"tells: confirmed={receipt.confirmed} {receipt.cause!r} {receipt.detail!r}")
                self.unit.told(receipt)
            case f.Log(event, values):
                self.world.tell(self.name, f"logs {event} {values}")

    def _publish(self) -> None:
        core, now = self.core, self.world.now
        assert core is not None
        ready = not core.recovering and core.silent(now) is None and core.watch.trouble(now) is None
        if self.notes.latch_told and core.latch.cause is None:
            raise Violation(f"{self.name} was latched, nobody has armed it, and it is not latched any more")
        self.notes.latch_told = core.latch.cause is not None and not self.notes.armed
        busy = core.watch.moving() or core.active is not None or bool(core.holder(now))
        self.unit.published(State(core.latch.cause, core.latch.hold, core.by_hand, ready, busy))

    def _forgotten(self) -> bool:
        """Whether all who could have heard the last press were killed before the disk had it: nothing is left of it."""
        noted = max(self.notes.stalls, self.pressed_at + WRITTEN)
        return all((one.life != life or not one.alive) and one.lost_at <= noted for one, life in self.heard_with)

    def _send(self, number: int) -> None:
        if self.latched and not self._forgotten():
            raise Violation(f"goal {number} leaves after a stop, before a re-arm")
        order = self.asked[number]
        run = order.owner.run if order.owner is not None else 0
        said = self.notes.armed or self.notes.pressed  # of a press that it has not heard yet
        if not said or not self.notes.holder or self.notes.run != run:
            raise Violation(f"goal {number} leaves, and the note does not say whose it is")
        if self.unit.driven:
            raise Violation(f"goal {number} leaves, and a person drives {self.unit.name}")
        self.world.tell(self.name, f"sends goal {number}")
        self.unit.leaves(order.owner)
        self.unit.check_owner(self.unit, order.owner)
        life = self.life

        def answer(word: str) -> None:
            event = e.CallAccepted(number) if word == "accepted" else e.CallEnded(number, word)
            self.world.send(f"{self.name} answers", lambda: self.happens(event) if self.life == life else None)

        self.world.send(f"{self.name} goals", lambda: self.unit.machine.send(number, order.seconds, answer))

    def _end(self, end: f.End) -> None:
        order = self.asked.pop(end.number)
        if end.outcome != "ABORTED" and self.unit.machine.plant.goal == end.number:
            raise Violation(f"goal {end.number} is told to have ended as {end.outcome}, and moves {self.unit.name}")
        self.world.tell(self.name, f"ends goal {end.number}: {end.outcome} {end.why!r}")
        if end.outcome == "SUCCEEDED" and end.number not in self.unit.machine.succeeded:
            raise Violation(f"goal {end.number} is told to have succeeded, and did not")
        order.end(end.outcome, end.why)

    def _answer(self, request: int, effect: f.Effect) -> None:
        if isinstance(effect, f.Stopped):
            self._check_latch(effect.receipt)
        _, answer = self.calls.pop(request)
        self.notes.rearming = self.notes.rearming and not isinstance(effect, f.Rearmed)
        self.world.send(f"{self.name} results", lambda: answer(effect))

    def _keep(self, effect: f.KeepState | f.KeepDriver | f.KeepReceipt) -> None:
        if isinstance(effect, f.KeepReceipt):
            self._check_receipt(effect.receipt)
        life = self.life

        def answer(event: e.Event) -> None:
            if isinstance(effect, f.KeepReceipt):
                self._kept.add(effect.receipt.stamp)
            self.happens(event)

        self.notes.keep(effect, lambda: self.alive and self.life == life, answer)

    def _check_receipt(self, receipt: f.Receipt) -> None:
        plant, (since, until) = self.unit.machine.plant, self.unit.levers
        began = self.world.now - plant.turned < UNSEEN  # a person, just now
        person = self.unit.driven or since <= self.world.now < until
        replays = plant.fault.replay or self.world.now - self.unit.replayed_at < UNSEEN
        hidden = replays and person  # its past does not tell of that person
        if receipt.confirmed and plant.moves() and not began and not hidden:
            raise Violation(f"confirmed and truly moving: {receipt.cause!r}")
        self._check_latch(receipt)

    def _check_latch(self, receipt: f.Receipt) -> None:
        if not receipt.confirmed and self.core is not None and self.core.latch.cause is None:
            raise Violation(f"{self.name} is not latched after a stop that is not confirmed: {receipt.cause!r}")
