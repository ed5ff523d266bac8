"""Computes when each message of a recording is due, and its new stamp."""

from collections.abc import Callable

from tms_config.clock import monotonic, unix_time

LATE = 0.5  # s of delay after which the plan is shifted, so that late messages do not come in one burst
SECOND = 1_000_000_000  # ns


class Pace:
    """Converts the recording's time to ours; moments are ns by the clock of the PC that recorded.

    The stamps of a topic keep their distances to each other (divided by the speed), and the first one becomes the
    moment at which it is published: how far the clock of its source was off at the recording does not matter now.
    """

    def __init__(
        self,
        first: int,
        speed: float,
        clock: Callable[[], float] = monotonic,
        wall: Callable[[], float] = unix_time,
    ) -> None:
        self._first, self.speed, self._clock, self._wall = first, speed, clock, wall
        self._stamps: dict[str, int] = {}  # topic -> ns to add to a stamp for a moment of the recording
        self.restart()

    def restart(self) -> None:
        """The recording begins again."""
        self._begin, self._begin_wall = self._clock(), self._wall()

    def wait(self, moment: int) -> float:
        """Seconds until a message is due."""
        seconds = self._begin + self._played(moment) - self._clock()
        if seconds < -LATE:
            self._begin -= seconds
            self._begin_wall -= seconds
        return max(0.0, seconds)

    def moment(self) -> int:
        """The moment that is due now."""
        return self._first + round((self._clock() - self._begin) * self.speed * SECOND)

    def stamp(self, topic: str, stamp: int, moment: int) -> int:
        """The new stamp (ns, clock of this PC) for a message's stamp (ns)."""
        to_moment = self._stamps.setdefault(topic, moment - stamp)
        return int(self._begin_wall * SECOND) + round(self._played(stamp + to_moment) * SECOND)

    def _played(self, moment: int) -> float:
        return (moment - self._first) / SECOND / self.speed
