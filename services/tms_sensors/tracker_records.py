"""Trackers that tell in a record of the database, which is asked ten times a second.

So a place is known a tenth of a second later than from a topic, and only while store and database process live.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

from tms_msg_db.srv import GetParameter

from tms_areas.areas import Point
from tms_areas.reasons import NoSwitch, PlacesUneven, TrackerClockAhead
from tms_areas.trackers import Tracker
from tms_config.clock import monotonic, unix_time
from tms_machine import stamps
from tms_machine.asking import ask
from tms_machine.values import Value, from_parameters
from tms_reason.errors import RosError, TmsError
from tms_ros.node import Ros

PERIOD = 0.1  # s between questions
LIMIT = 1.0  # s for an answer
KEPT = 100  # answers between two looks
ANY_AGE = -1.0  # the age of a record is judged here
AHEAD = 0.5  # s that the clock of a tracker may be ahead of ours


@dataclass(frozen=True)
class Told:
    """What a record said."""

    tracker: str
    received: float  # monotonic [s]
    fields: Mapping[str, Value]
    updated: float  # s since 1970

    def age(self) -> float:
        """How long ago it was measured [s].

        Raises:
            TmsError: later than now.
        """
        return age_since(self.updated, unix_time())

    def places(self) -> list[Point]:
        """Where somebody is [m, map].

        Raises:
            TmsError: PlacesUneven.
        """
        x, y = (_numbers(self.fields.get(name)) for name in ("x", "y"))
        if x is None or y is None or len(x) != len(y):
            raise TmsError(PlacesUneven())
        return list(zip(x, y, strict=True))

    def opened(self) -> bool:
        """What a gate says.

        Raises:
            TmsError: NoSwitch.
        """
        if not isinstance(opened := self.fields.get("opened"), bool):
            raise TmsError(NoSwitch())
        return opened


class TrackerRecords:
    """Asks in a thread of its own."""

    def __init__(self, ros: Ros, trackers: Mapping[str, Tracker]) -> None:
        self._ros, self._trackers = ros, trackers
        self._told: deque[Told] = deque(maxlen=KEPT)
        if trackers:
            ros.poll_in_thread(PERIOD, self._ask, "tracker records")

    def take(self) -> list[Told]:
        """What came since the last call."""
        return [self._told.popleft() for _ in range(len(self._told))]

    def _ask(self) -> None:
        for name, given in self._trackers.items():
            request = GetParameter.Request(model_name=given.model, record_name=given.record, max_age=ANY_AGE)
            try:
                record = ask(self._ros, GetParameter, "/tms/db/get_parameter", request, LIMIT).record
            except RosError:  # it becomes silent, and why is told by the database's own process
                continue
            fields = from_parameters(record.values)
            self._told.append(Told(name, monotonic(), fields, stamps.seconds(record.updated_at)))


def age_since(stamp: float, now: float) -> float:
    """How long ago something was measured [s]; 0 without a stamp. Both: s since 1970.

    Raises:
        TmsError: it was measured later than now.
    """
    if stamp - now > AHEAD:
        raise TmsError(TrackerClockAhead(stamp - now))
    return max(0.0, now - stamp) if stamp else 0.0


def _numbers(value: Value | None) -> list[float] | None:
    found = value if isinstance(value, list) else [value]
    fine = all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in found)
    return [float(one) for one in found if isinstance(one, (int, float))] if fine else None
