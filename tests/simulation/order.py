"""A goal on its way from a client to a server, and the answers on their way back."""

from collections.abc import Callable
from dataclasses import dataclass

from simulation.world import World
from tms_decision.owner import Owner
from tms_reason.reason import Reason

Accepted = Callable[[], None]
Ended = Callable[[str, Reason | None], None]


@dataclass
class Order:
    """One sending of a goal. Its callbacks are those of a life of the client."""

    world: World
    topic: str
    owner: Owner | None  # None: a foreign client
    seconds: float
    accepted: Accepted = lambda: None
    ended: Ended = lambda outcome, why: None
    at_server: int = 0  # its number there
    over: bool = False

    def accept(self) -> None:
        """The server takes it."""
        self.world.send(f"{self.topic} back", self.accepted)

    def end(self, outcome: str, why: Reason | None = None) -> None:
        """The server has ended it."""
        if not self.over:
            self.over = True
            self.world.send(f"{self.topic} back", lambda: self.ended(outcome, why))
