"""Holding shared places for one goal: until the machine has them it waits, and wants them no more at the end.

They are free again once the machine is outside (the keeper sees to it, and the end of the run for what gets lost).
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from tms_msg_areas.srv import AskPlaces

from tms_config.clock import monotonic, sleep
from tms_kit.site_places import SitePlaces
from tms_machine.asking import ask
from tms_places.reasons import WaitsForKeeper
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_ros.node import Ros

ASK, ASK_LIMIT = "/tms/places/ask", 3.0  # s for the keeper to answer
ASK_AGAIN = 2.0  # s after it did not
LOOK = 0.1  # s between looks whether the machine may go


@contextmanager
def holding(
    ros: Ros, site: SitePlaces, machine: str, places: Sequence[str], waits: Callable[[Reason], None]
) -> Iterator[None]:
    """Around a goal.

    `waits` is called with the reason, again and again; what it raises ends the wait.
    """
    request = AskPlaces.Request(machine=machine, places=list(places), hold=True)
    try:
        site.answered(_ask(ros, request, lambda: waits(WaitsForKeeper(machine, places[0]))))
        while (why := next(filter(None, (site.waits(machine, place) for place in places)), None)) is not None:
            waits(why)
            sleep(LOOK)
        yield
    finally:  # without waiting for the answer: the motion may have to be cancelled now
        ros.call_unanswered(AskPlaces, ASK, AskPlaces.Request(machine=machine, hold=False))


def _ask(ros: Ros, request: AskPlaces.Request, waits: Callable[[], None]) -> int:
    """Until the keeper has taken it; the revision of its book then."""
    while True:
        try:
            return ask(ros, AskPlaces, ASK, request, ASK_LIMIT).revision
        except RosError:
            until = monotonic() + ASK_AGAIN
            while monotonic() < until:
                waits()
                sleep(LOOK)
