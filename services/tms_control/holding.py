"""Which angles hold the joints of a machine that is stopped, and when its emergency stop may be released. Pure logic.

The drives of OperaSim-PhysX go on to the last angle that they were sent, and its `front_cmd` delays angles: what was
sent before a stop still comes afterwards. So the joints are held where they are, anew until the last of that has come,
and from then on at one place: a joint that sags a little must not be followed down.

After a release of `emg_stop` the simulator does what was sent before the stop. So nothing is released before all of
that is over, and the joints are held at once, several times: an angle that arrives with the release is lost.
"""

from collections.abc import Mapping
from dataclasses import dataclass

MARGIN = 0.3  # s after the longest dead time: a last command may be on its way, and the simulator slow
RELEASE_MARGIN = 1.0  # s, the same before the release
HOLDS = 0.3  # s more for which the joints are held: messages to a simulator may be late

Angles = Mapping[str, float]


@dataclass(frozen=True)
class Orders:
    """What to send now."""

    angles: Angles | None = None  # rad, of all joints that are held
    release: bool = False  # emg_stop


def released_after(dead_time: float) -> float:
    """How long after a stop its emergency stop is released at the earliest [s]."""
    return dead_time + RELEASE_MARGIN if dead_time else 0.0


class Holding:
    """Times are monotonic seconds."""

    def __init__(self, dead_time: float, droops: Angles) -> None:
        """`dead_time` [s]: the longest of the joints' commands, 0 if they act at once; `droops` [rad] by joint."""
        self._plays = dead_time + MARGIN
        self._waits = released_after(dead_time)
        self._droops = droops
        self._begun: float | None = None  # s, of the last stop
        self._ends = float("-inf")  # s, until when the joints are held
        self._angles: dict[str, float] = {}
        self._releases: float | None = None  # s, when the emergency stop is due to be released

    @property
    def busy(self) -> bool:
        """Whether something is still to be sent: no goal may begin before."""
        return self._begun is not None or self._releases is not None

    def stop(self, now: float) -> None:
        """The machine is stopped, or its stop is repeated: hold the joints where they are."""
        if self._begun is None:
            self._begun, self._angles = now, {}
        self._ends = max(self._ends, self._begun + self._plays + HOLDS)

    def press(self) -> None:
        """The emergency stop is pressed: it is not released any more."""
        self._releases = None

    def release(self, now: float) -> None:
        """Release the emergency stop as soon as nothing that was sent before the stop can move the joints."""
        begun = now - self._waits if self._begun is None else self._begun
        self._releases = max(now, begun + self._waits)

    def step(self, now: float, measured: Angles) -> Orders:
        """What to send now; `measured` are the joints' angles [rad], none while they are not heard."""
        release = self._releases is not None and now >= self._releases
        if release:
            self._releases = None
            self._begun, self._ends = now - self._plays, max(self._ends, now + HOLDS)
            self._angles = self._held(measured)
        if self._begun is None:
            return Orders()
        if not measured or not self._angles or now - self._begun < self._plays:
            self._angles = self._held(measured)
        orders = Orders(self._angles or None, release)
        if now >= self._ends:
            self._begun = None
        return orders

    def _held(self, measured: Angles) -> dict[str, float]:
        return {joint: angle + self._droops.get(joint, 0.0) for joint, angle in measured.items()}
