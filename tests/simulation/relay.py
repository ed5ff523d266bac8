"""A subtask or a planner: it passes each goal on to the next process, and stands behind it meanwhile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from simulation.lease import PermitProcess
from simulation.order import Order
from tms_decision import STOP_PROVEN
from tms_decision.permit_link import NOBODY, PermitLink
from tms_decision.reasons import ProcessLost
from tms_reason.reason import Foreign, Reason

if TYPE_CHECKING:
    from simulation.unit import Unit

ACCEPT_LIMIT = 3.0  # s for the next process to answer
LEAVES = 0.8  # s from its cancel until a process that ends in order is gone
ENDS_LIMIT = STOP_PROVEN + 2.5  # s for a cancelled motion to end
BUSY, UNREACHED = Foreign("busy"), Foreign("no answer")


class Server(Protocol):
    """Where a goal is sent."""

    def ask(self, order: Order) -> None: ...

    def cancel(self, order: Order) -> None: ...


class Relay(PermitProcess):
    """Serves one goal at a time."""

    def __init__(self, unit: Unit, permit: str, follows: str) -> None:
        """`permit`: its own; `follows`: that of the next process."""
        super().__init__(unit.world, f"{unit.name}:{permit}", {unit.name: unit.permits[permit]})
        self.unit, self._follows = unit, follows
        self._link = PermitLink(follows)
        self._order: Order | None = None  # that it serves
        self._passed: Order | None = None  # as it has sent it on
        self._accepted = self._cancelled = False

    def begin(self) -> None:
        super().begin()
        self._order = self._passed = None
        self._link = link = PermitLink(self._follows)
        self.unit.permits[self._follows].join(
            f"{self.name}{self.life}",
            self.in_life(lambda goal, holder: link.heard(goal, holder, self.world.now)),
            self.in_life(self._reported),
        )

    def end(self) -> None:
        """End in order: cancel the goal that it has sent, which has a moment to end, and answer nothing any more."""
        passed, self._passed = self._passed, None
        if passed is None:
            super().end()
        else:
            self.world.send(f"{self.name} cancels", lambda: self._next.cancel(passed))
            self.later(LEAVES, super().end)

    @property
    def _next(self) -> Server:
        return self.unit.server(self._follows)

    def ask(self, order: Order) -> None:
        """A goal arrives."""
        self.handle(lambda: self._ask(order))

    def _ask(self, order: Order) -> None:
        if self._order is not None:
            order.end("REJECTED", BUSY)
            return
        assert order.owner is not None
        self._order, self._accepted, self._cancelled = order, False, False
        self.permits[self.unit.name].hold(order.owner.goal_id(b"abc"))
        order.accept()
        passed = self._passed = Order(
            self.world, f"{self.name} goals", order.owner.next(), order.seconds,
            self.in_life(lambda: self._was_accepted(passed)),
            self.in_life(lambda outcome, why: self._has_ended(passed, outcome, why)),
        )  # fmt: skip
        self.world.send(passed.topic, lambda: self._next.ask(passed))
        self.later(ACCEPT_LIMIT, lambda: self._unanswered(passed))

    def cancel(self, order: Order) -> None:
        """Its client cancels the goal."""
        self.handle(lambda: self._stop() if order is self._order else None)

    def _stop(self) -> None:
        self._cancelled = True
        passed = self._passed
        if passed is not None:
            self.world.send(f"{self.name} cancels", lambda: self._next.cancel(passed))
            self.later(ENDS_LIMIT, lambda: self._has_ended(passed, "ABORTED", UNREACHED))

    def _was_accepted(self, passed: Order) -> None:
        if passed is self._passed:
            self._accepted = True
            if self._cancelled:
                self.world.send(f"{self.name} cancels", lambda: self._next.cancel(passed))

    def _unanswered(self, passed: Order) -> None:
        if passed is self._passed and not self._accepted:
            self.world.send(f"{self.name} cancels", lambda: self._next.cancel(passed))
            self._has_ended(passed, "ABORTED", UNREACHED)

    def _reported(self, alive: int, not_alive: int) -> None:
        """The next process may be lost: then the goal there never ends."""
        link, now = self._link, self.world.now
        link.reported(alive, not_alive, False, now)
        if self._passed is not None and link.goal != NOBODY and not link.alive(now):
            self._has_ended(self._passed, "ABORTED", ProcessLost(Foreign(f"{self._follows} is lost")))

    def _has_ended(self, passed: Order, outcome: str, why: Reason | None) -> None:
        order = self._order
        if passed is not self._passed or order is None:
            return
        self._order = self._passed = None
        self.permits[self.unit.name].hold(NOBODY)
        succeeded, cancelled = outcome == "SUCCEEDED", self._cancelled and outcome == "CANCELED"
        order.end("SUCCEEDED" if succeeded else "CANCELED" if cancelled else "ABORTED", why)
