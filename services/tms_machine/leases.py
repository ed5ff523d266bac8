"""Who asserts a leased topic, as one that subscribes to it knows."""

from collections.abc import Callable
from typing import Any

from tms_ros.interface_types import M
from tms_ros.node import Ros

ASSERTED = 0.1  # s in which the news that a publisher is asserted follows its message, twice


def subscribe(
    ros: Ros,
    message_type: type[M],
    topic: str,
    seconds: float,
    on_message: Callable[[M], None],
    alive: Callable[[int, int], None],
) -> Any:
    """Call `on_message` with messages and `alive` with the numbers of publishers that are, and are not, asserted.

    A publisher that was killed counts as not asserted until discovery has dropped it.
    """

    count = _Count(alive)

    def received_first(message: M) -> None:
        if not count.known:
            # In two steps: what was reported meanwhile is handled before the second one.
            ros.after(ASSERTED, lambda: ros.after(ASSERTED, count.made_up))
        on_message(message)

    return ros.lease_subscribe(message_type, topic, seconds, received_first, count.reported)


class _Count:
    """Publishers that are, and are not, asserted, as one subscription knows them.

    Fast DDS tells a reader of changes only, and not of those from before it is registered: of a publisher that was
    asserted a moment too early, or that another reader of this process knows already, it counts from 0 down to -1.
    Such a one has sent its message all the same, and that counts as an assertion.
    """

    def __init__(self, alive: Callable[[int, int], None]) -> None:
        self._alive, self._missed = alive, 0
        self.known = False  # whether anything was reported

    def reported(self, event: Any) -> None:
        """By DDS."""
        self.known = True
        self._missed = max(self._missed, -event.alive_count)
        if event.not_alive_count < 0:  # the one that was missed has ended since, and that was missed, too
            self._missed = 0
        self._alive(max(0, event.alive_count + self._missed), max(0, event.not_alive_count))

    def made_up(self) -> None:
        """A message came, and nothing was reported."""
        if not self.known:
            self.known, self._missed = True, 1
            self._alive(1, 0)
