"""One source that tells of a machine's motion: what it said, and why its word may count for nothing. Pure logic."""

from collections.abc import Mapping
from dataclasses import dataclass

from tms_config.models import Source
from tms_rc.channel import Channel, Limits, Place, distance
from tms_rc.reasons import (
    Implausible,
    Imu,
    JointStates,
    ManyPublishers,
    NewClock,
    Odometry,
    Old,
    OldOf,
    Pose,
    StampRepeated,
    TwoPublishers,
    Unheard,
    UnheardOf,
)
from tms_rc.stamps import StampClock, Verdict
from tms_reason.reason import Reason

LABELS: dict[str, Reason] = {"joint_states": JointStates(), "odom": Odometry(), "pose": Pose(), "imu": Imu()}
PERIODS = 3  # that a stamp may stand still, or nothing come
SHORTEST = 0.2  # s; the gateway looks 20 times a second, and PCs are busy
SETTLED = 5.0  # s that a machine must have stood before a new clock of its source is taken for good
MIXED = 2.0  # s in which publication numbers that go back twice tell of two publishers


@dataclass(frozen=True)
class Sample:
    """One message of a source."""

    received: float  # s, monotonic
    stamp: float  # s of the source's own clock
    number: int  # publication sequence number of its publisher
    places: Mapping[str, Place]  # channels of the source only -> rad, or m
    speeds: Mapping[str, float]  # channel -> rad/s or m/s, where told


@dataclass(frozen=True)
class Trouble:
    """Why a source cannot be believed; one that `passes` goes away by itself, and its machine is held, not latched."""

    reason: Reason
    passes: bool = False


class SourceWatch:
    """All channels of one source."""

    def __init__(self, name: str, source: Source, channels: Mapping[str, Limits]) -> None:
        self.label, self.source = LABELS[name], source
        self.channels = {key: Channel(limits) for key, limits in channels.items()}
        self._limits = dict(channels)
        self._clock = StampClock(source.stamps)
        self._advanced: float | None = None  # when a sample with a new stamp came
        # Tuples that are replaced, never changed: other threads read them without a lock.
        self._repeats: tuple[float, ...] = ()  # when stamps came that did not advance
        self._number, self._back = 0, tuple[float, ...]()  # last number, and when numbers went back
        self.new_clock: tuple[float, Reason] | None = None  # since when, why
        self.fast = False  # its last message showed a motion
        self.publishers: tuple[str, ...] = ()  # nodes, where there is more than one
        self._values: object = None
        self.changed = float("-inf")  # when its values were last not the same bit for bit

    @property
    def longest(self) -> float:
        """Seconds without a new stamp after which it proves nothing."""
        return max(PERIODS * self.source.period, SHORTEST)

    def take(self, sample: Sample) -> None:
        """Take one message."""
        if sample.number < self._number or (sample.number == self._number and sample.number > 0):
            self._back = (*self._back, sample.received)[-2:]
        self._number = sample.number
        judged = self._clock.judge(sample.received, sample.stamp)
        if judged.verdict is Verdict.REPEATED:
            self._repeats = (*self._repeats, sample.received)[-PERIODS:]
            return
        if judged.verdict is Verdict.NEW_CLOCK:
            assert judged.why is not None, "a new clock has a reason"
            self.new_clock = sample.received, judged.why
            for channel in self.channels.values():
                channel.clear()
        self._repeats = ()
        self._advanced = sample.received
        values = (dict(sample.places), dict(sample.speeds))
        if values != self._values:
            self._values, self.changed = values, sample.received
        self.fast = False
        for name, place in sample.places.items():
            channel = self.channels[name]
            channel.add(sample.received, judged.measured, place, sample.speeds.get(name))
            self.fast = self.fast or (channel.last is not None and channel.last.fast)

    def age(self, now: float) -> float:
        """Seconds since the channel that was silent for longest was received; infinite before the first word of it."""
        last = [channel.last for channel in self.channels.values()]
        return max((float("inf") if one is None else now - one.received for one in last), default=float("inf"))

    def silent(self, now: float, limit: float) -> Reason | None:
        """What was not heard for `limit` seconds."""
        for name, channel in self.channels.items():
            last = channel.last
            whole = len(self.channels) == 1 or self._advanced is None
            if last is None:
                return Unheard(self.label) if whole else UnheardOf(self.label, name)
            age = now - last.received
            if age > limit:
                return Old(self.label, age) if whole else OldOf(self.label, name, age)
        return None

    def trouble(self, now: float) -> Trouble | None:
        """Why its word counts for nothing now."""
        publishers, back, repeats, new_clock = self.publishers, self._back, self._repeats, self.new_clock
        if publishers:
            return Trouble(ManyPublishers(self.label, len(publishers), publishers))
        if len(back) == 2 and now - back[0] < MIXED:
            return Trouble(TwoPublishers(self.label))
        if len(repeats) == PERIODS and now - repeats[0] < MIXED:
            return Trouble(StampRepeated(self.label))
        for name, channel in self.channels.items():
            if why := channel.disagreement():
                return Trouble(Implausible(self.label, name, why))
        if new_clock is not None:
            return Trouble(NewClock(self.label, new_clock[1]), passes=True)
        return None

    def accept_clock(self) -> None:
        """A person has looked: the new clock is the source's."""
        self.new_clock = None

    def settle(self, now: float, stands: bool) -> None:
        """Take a new clock for good once the machine has stood long enough by it."""
        new_clock = self.new_clock
        if new_clock is not None and not stands:
            self.new_clock = max(new_clock[0], now), new_clock[1]
        elif new_clock is not None and now - new_clock[0] >= SETTLED:
            self.new_clock = None

    @property
    def surprised(self) -> float:
        """When a channel was last somewhere that no motion leads to."""
        return max(channel.surprised for channel in self.channels.values())

    def moving(self) -> bool:
        """Whether any channel moved, or nobody knows."""
        return any(channel.moving() for channel in self.channels.values())

    def proves(self, start: float, now: float, seconds: float) -> bool:
        """Whether every channel was seen to stand for `seconds` after `start`, by fresh samples."""
        if self.age(now) > self.longest or self.publishers:
            return False
        return all(channel.stood_since(start, seconds) for channel in self.channels.values())

    def travel(self, marks: Mapping[str, Place]) -> dict[str, float]:
        """Way of each channel since its mark [rad or m]."""
        found = {}
        for name, channel in self.channels.items():
            if channel.last is not None and channel.last.place and name in marks:
                found[name] = distance(marks[name], channel.last.place, self._limits[name].turns)
        return found

    def places(self) -> dict[str, Place]:
        """The last position of each channel."""
        return {name: one.last.place for name, one in self.channels.items() if one.last is not None and one.last.place}
