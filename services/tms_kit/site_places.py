"""Shared places as their keeper tells them on /tms/places."""

from collections.abc import Callable
from datetime import datetime

from builtin_interfaces.msg import Time
from tms_msg_areas.msg import Place, Places

from tms_machine import stamps
from tms_places.reasons import WaitsForKeeper, WaitsForLease, WaitsForPlace, WaitsItsTurn
from tms_reason.reason import Reason
from tms_ros.node import Ros


class SitePlaces:
    """Who holds which place, and who waits for it."""

    def __init__(self, ros: Ros, changed: Callable[[], None] = lambda: None) -> None:
        """`changed` is called on the executor thread."""
        self._told: dict[str, Place] | None = None  # replaced, never changed
        self._revision = self._since = 0  # of what was told; of the last answer, which older news does not know
        self._changed = changed
        ros.subscribe(Places, "/tms/places", self._heard, latched=True)

    @property
    def names(self) -> tuple[str, ...] | None:
        """The places of the site; None while nobody has told of them."""
        return None if self._told is None else tuple(self._told)

    @property
    def runs(self) -> frozenset[str]:
        """Runs that hold a place or wait for one."""
        told = (self._told or {}).values()
        return frozenset({one.run for one in told} | {each.run for one in told for each in one.queue}) - {""}

    def answered(self, revision: int) -> None:
        """The keeper has taken what was asked: only what it tells from now on counts."""
        self._since = revision

    def waits(self, machine: str, place: str) -> Reason | None:
        """Why a machine that wants a place must not go there yet; None: its gateway lets it in."""
        told = (self._told or {}).get(place)
        if self._revision < self._since:
            return WaitsForKeeper(machine, place)
        queue = [] if told is None else [one.machine for one in told.queue]
        if told is not None and told.holder == machine:
            if told.state == Place.HELD:
                return None
            if told.state == Place.GRANTED:
                return WaitsForLease(machine, place)
        if told is None or machine not in queue:
            return WaitsForKeeper(machine, place)
        if told.holder not in ("", machine):
            return WaitsForPlace(machine, place, told.holder, _clock(told.since))
        ahead = queue[: queue.index(machine)]
        return WaitsItsTurn(machine, place, ahead[0]) if ahead else WaitsForLease(machine, place)

    def _heard(self, told: Places) -> None:
        self._revision = told.revision
        self._told = {one.name: one for one in told.places}
        self._changed()


def _clock(since: Time) -> str:
    return datetime.fromtimestamp(stamps.seconds(since)).astimezone().strftime("%H:%M:%S")
