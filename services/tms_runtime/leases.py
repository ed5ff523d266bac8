"""How many publishers assert a leased topic, as a subscription knows it."""

from collections.abc import Callable
from typing import Any

from tms_interfaces.generated import M
from tms_ros.node import Ros

ASSERTED = 0.1  # s, waited twice, for DDS to report a publisher as asserted after its message


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
            # In two steps: reports that have come meanwhile are handled before the second one.
            ros.after(ASSERTED, lambda: ros.after(ASSERTED, count.made_up))
        on_message(message)

    return ros.lease_subscribe(message_type, topic, seconds, received_first, count.reported)


class _Count:
    """Publishers that are, and are not, asserted, as one subscription knows them.

    Fast DDS reports only changes to a reader, and only those after its registration: a publisher that was asserted a
    moment too early, or that another reader of this process already knows, is counted from 0 down to -1.
    Such a publisher has sent its message all the same, and that counts as an assertion.
    """

    def __init__(self, alive: Callable[[int, int], None]) -> None:
        self._alive, self._missed = alive, 0
        self.known = False  # whether DDS has reported a change

    def reported(self, event: Any) -> None:
        """Take a report of DDS."""
        self.known = True
        self._missed = max(self._missed, -event.alive_count)
        if event.not_alive_count < 0:  # DDS has not reported the end of the missed one either
            self._missed = 0
        self._alive(max(0, event.alive_count + self._missed), max(0, event.not_alive_count))

    def made_up(self) -> None:
        """Count a publisher whose message came without a report of DDS."""
        if not self.known:
            self.known, self._missed = True, 1
            self._alive(1, 0)
