"""When each message of a recording is due, and what its stamp becomes then."""

from collections.abc import Callable

from tms_config.clock import monotonic, unix_time

LATE = 0.5  # s behind at which the plan moves: what was missed is not made up for in one burst
SECOND = 1_000_000_000  # ns


class Pace:
    """From the recording's time to ours; moments are ns by the clock of the PC that recorded.

    The stamps of a topic keep their distance to each other (divided by the speed, as everything), and the first one
    becomes the moment at which it is published: how far the clock of its source was off then says nothing today.
    """

    def __init__(
        self,
        first: int,
        speed: float,
        clock: Callable[[], float] = monotonic,
        wall: Callable[[], float] = unix_time,
    ) -> None:
        self._first, self.speed, self._clock, self._wall = first, speed, clock, wall
        self._stamps: dict[str, int] = {}  # topic -> what is added to a stamp to get a moment of the recording
        self.restart()

    def restart(self) -> None:
        """The recording begins again."""
        self._begin, self._begin_wall = self._clock(), self._wall()

    def wait(self, moment: int) -> float:
        """S until a message is due."""
        seconds = self._begin + self._played(moment) - self._clock()
        if seconds < -LATE:
            self._begin -= seconds
            self._begin_wall -= seconds
        return max(0.0, seconds)

    def moment(self) -> int:
        """What is due now."""
        return self._first + round((self._clock() - self._begin) * self.speed * SECOND)

    def stamp(self, topic: str, stamp: int, moment: int) -> int:
        """What a stamp (ns) of a message becomes (ns, clock of this PC)."""
        to_moment = self._stamps.setdefault(topic, moment - stamp)
        return int(self._begin_wall * SECOND) + round(self._played(stamp + to_moment) * SECOND)

    def _played(self, moment: int) -> float:
        return (moment - self._first) / SECOND / self.speed
