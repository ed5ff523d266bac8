"""Tells from joint states and odometry whether a machine stands, and how far it has moved since a mark. Pure logic."""

import math
from collections.abc import Mapping, Sequence

from tms_core.models import Still

JOINTS, ODOM = "joint states", "odometry"
INFINITE = float("inf")


class StandStill:
    """Fed with joint states and odometry; all times are seconds of one monotonic clock."""

    def __init__(self, still: Still, sources: Sequence[str] = (JOINTS,)) -> None:
        """`sources` are those that the machine has: each must be fresh for the machine to count as standing."""
        self._still = still
        self._heard: dict[str, float | None] = dict.fromkeys(sources)
        self._slow: dict[str, bool] = {}
        self._joints_at: dict[str, float] = {}
        self._positions: dict[str, float] = {}
        self._velocities: dict[str, float] = {}
        self._place: tuple[float, float] | None = None  # m
        self._slow_since: float | None = None
        self._mark: dict[str, float] = {}
        self._mark_place: tuple[float, float] | None = None
        self._travel = 0.0

    def update(self, now: float, positions: Mapping[str, float], velocities: Mapping[str, float]) -> None:
        """Take one joint state [rad, rad/s]; a joint without velocity gets it from its last position.

        Every joint that was heard once counts: the joints are as old as the one that is silent for longest.
        """
        if not positions:
            return
        speeds = dict(self._velocities)
        for name, position in positions.items():
            gap = now - self._joints_at.get(name, now)
            if name in velocities:
                speeds[name] = velocities[name]
            elif gap > 0:
                speeds[name] = (position - self._positions[name]) / gap
            self._travel = max(self._travel, abs(position - self._mark.get(name, position)))
        # New dicts, not changed ones: stop paths read them from other threads without a lock.
        self._positions, self._velocities = {**self._positions, **positions}, speeds
        self._joints_at |= dict.fromkeys(positions, now)
        self._see(JOINTS, now, all(abs(velocity) < self._still.velocity for velocity in speeds.values()))
        self._heard[JOINTS] = min(self._joints_at.values())

    def update_odometry(self, now: float, place: tuple[float, float], linear: float, angular: float) -> None:
        """Take one odometry message: place [m], speeds [m/s, rad/s]."""
        start = self._mark_place or place
        self._travel = max(self._travel, math.dist(start, place))
        self._place = place
        self._see(ODOM, now, abs(linear) < self._still.linear and abs(angular) < self._still.angular)

    def _see(self, source: str, now: float, slow: bool) -> None:
        self._heard[source] = now
        self._slow[source] = slow
        if not all(self._slow.values()):
            self._slow_since = None
        elif self._slow_since is None:
            self._slow_since = now

    @property
    def positions(self) -> dict[str, float]:
        """Last position of each joint [rad]."""
        return dict(self._positions)

    @property
    def velocities(self) -> dict[str, float]:
        """Last velocity of each joint [rad/s]."""
        return dict(self._velocities)

    def age(self, now: float) -> float:
        """Seconds since the last message of the source that is silent for longest, infinite before the first."""
        return max((INFINITE if at is None else now - at for at in self._heard.values()), default=INFINITE)

    def silent(self, now: float, limit: float) -> str | None:
        """The source that was not heard for `limit` seconds, in words."""
        for source, at in self._heard.items():
            if at is None:
                return f"no {source} from the machine yet"
            if now - at > limit:
                return f"{source} {now - at:.1f} s old"
        return None

    def moving(self) -> bool:
        """Whether the last messages showed a motion, or there were none."""
        return self._slow_since is None

    def standing(self, now: float) -> bool:
        """Whether it has been seen to stand long enough, by messages that are still fresh."""
        since = self._slow_since  # read once: another thread may reset it
        fresh = self.age(now) < max(0.5, self._still.seconds)
        return fresh and since is not None and now - since >= self._still.seconds

    def mark(self) -> None:
        """Begin to count travel anew."""
        self._mark, self._mark_place, self._travel = dict(self._positions), self._place, 0.0

    def travel(self) -> float:
        """Largest motion since the mark: of one joint [rad], or of the machine [m]."""
        return self._travel
