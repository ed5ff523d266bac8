"""What must be seen after one stop, until the machine counts as standing. Pure logic."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

INFINITE = float("inf")
SEEN, SHARE = 0.003, 0.5  # a commanded motion above so many rad must be seen, and this share of it


@dataclass(frozen=True)
class Expected:
    """The motion that must be seen, or must have been seen, for the sources to be believed."""

    since: float | None = None  # s, monotonic, when it began; None: no motion was commanded
    to_come: Mapping[str, float] = field(default_factory=dict)  # joint -> rad that were commanded and not seen yet
    behind: Mapping[str, tuple[float, float]] = field(default_factory=dict)  # joint -> where it began, rad it went

    def seen(self, motion_at: float, travel: Mapping[str, float], places: Mapping[str, float]) -> bool:
        """Whether it was seen, by the last motion [s], and by travel since the stop and places of the joints [rad].

        A machine that replays a record of another motion shows one, too, but at another place.
        """
        far = {name: abs(places.get(name, begun) - begun) for name, (begun, _) in self.behind.items()}
        return (
            (self.since is None or motion_at > self.since)
            and all(travel.get(name, 0.0) >= SHARE * way for name, way in self.to_come.items())
            and all(way <= SEEN or far[name] >= SHARE * way for name, (_, way) in self.behind.items())
        )


NOTHING = Expected()
# For a restarted gateway: it sees only a part of the motion that was commanded. Without this, a machine that coasts and
# replays a record of its last seconds, in which the motion had just begun, would be believed to stand.
UNKNOWN = Expected(INFINITE)


@dataclass(frozen=True)
class Proof:
    """What must be seen after one stop."""

    start: float  # s, monotonic: only later measurements count ...
    unseen: float  # s, ... and only those after this, if the expected motion was never seen
    expected: Expected
    seconds: float  # s of standing
    immediate: bool = False  # the stop also cancels commands that are on their way

    def later(self, start: float) -> "Proof":
        """The same from a moment on."""
        return replace(self, start=max(self.start, start), unseen=max(self.unseen, start))

    def after(self, other: "Proof") -> "Proof":
        """What must be seen if another stop was commanded before: the motion that it waits for may still come.

        An immediate stop cancels what was on its way, but not the doubt whether the sources tell what moves.
        """
        since = [one for one in (self.expected.since, other.expected.since) if one is not None]
        mine, others = self.expected.to_come, other.expected.to_come
        behind = {**other.expected.behind, **self.expected.behind}  # of each joint, its last goal
        to_come = {name: max(mine.get(name, 0.0), others.get(name, 0.0)) for name in {*mine, *others}}
        expected = Expected(max(since, default=None), {} if self.immediate else to_come, behind)
        start = self.start if self.immediate else max(self.start, other.start)
        unseen = max(self.unseen, other.unseen)
        return Proof(start, unseen, expected, max(self.seconds, other.seconds), self.immediate)
