"""One source of a machine's motion: its samples, and why they may not be believed. Pure logic."""

from collections.abc import Mapping
from dataclasses import dataclass

from tms_proof.channel import Channel, Limits, Place, distance
from tms_proof.facts import PERIODS, SourceFacts
from tms_proof.reasons import (
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
from tms_proof.stamps import StampClock, StampVerdict
from tms_reason.reason import Reason

LABELS: dict[str, Reason] = {"joint_states": JointStates(), "odom": Odometry(), "pose": Pose(), "imu": Imu()}
SETTLED = 5.0  # s that a machine must have stood before a new clock of its source is accepted
MIXED = 2.0  # s; publication numbers that go back twice in this time mean two publishers


@dataclass(frozen=True)
class SourceSample:
    """One message of a source."""

    received: float  # s, monotonic
    stamp: float  # s of the source's own clock
    number: int  # publication sequence number of its publisher
    places: Mapping[str, Place]  # channel, of this source only -> rad or m
    speeds: Mapping[str, float]  # channel -> rad/s or m/s, where the message has it


@dataclass(frozen=True)
class Trouble:
    """Why a source cannot be believed; one that `passes` ends by itself, and the machine is held, not latched."""

    reason: Reason
    passes: bool = False


class SourceWatch:
    """All channels of one source."""

    def __init__(self, name: str, source: SourceFacts, channels: Mapping[str, Limits]) -> None:
        self.label, self.source = LABELS[name], source
        self.longest = source.longest
        self.channels = {key: Channel(limits) for key, limits in channels.items()}
        self._limits = dict(channels)
        self._clock = StampClock(source.stamps)
        self._advanced: float | None = None  # when the last sample with a new stamp came
        # Tuples are replaced, never changed: other threads read them without a lock.
        self._repeats: tuple[float, ...] = ()  # when messages came whose stamps did not advance
        self._number, self._back = 0, tuple[float, ...]()  # the last number, and when numbers went back
        self.new_clock: tuple[float, Reason] | None = None  # since when, why
        self.fast = False  # whether its last message showed a motion ...
        self.evident = False  # ... that no replayed record could hide
        self.publishers: tuple[str, ...] = ()  # nodes, where there is more than one
        self._places: dict[str, Place] | None = None  # see `places`
        self._values: object = None
        self.changed = float("-inf")  # when its values last changed in any bit

    def take(self, sample: SourceSample) -> None:
        """Take one message."""
        if sample.number < self._number or (sample.number == self._number and sample.number > 0):
            self._back = (*self._back, sample.received)[-2:]
        self._number, self._places = sample.number, None
        judged = self._clock.judge(sample.received, sample.stamp)
        if judged.verdict is StampVerdict.REPEATED:
            self._repeats = (*self._repeats, sample.received)[-PERIODS:]
            return
        if judged.verdict is StampVerdict.NEW_CLOCK:
            assert judged.why is not None, "a new clock has a reason"
            self.new_clock = sample.received, judged.why
            for channel in self.channels.values():
                channel.clear()
        self._repeats = ()
        self._advanced = sample.received
        values = (dict(sample.places), dict(sample.speeds))
        if values != self._values:
            self._values, self.changed = values, sample.received
        self.fast = self.evident = False
        for name, place in sample.places.items():
            channel = self.channels[name]
            channel.add(sample.received, judged.measured, place, sample.speeds.get(name))
            self.fast = self.fast or (channel.last is not None and channel.last.fast)
            self.evident = self.evident or channel.evident

    def age(self, now: float) -> float:
        """Seconds since the last sample of the channel that is silent for longest; infinite before its first one."""
        last = [channel.last for channel in self.channels.values()]
        return max((float("inf") if one is None else now - one.received for one in last), default=float("inf"))

    def silent(self, now: float, limit: float) -> Reason | None:
        """The channel of which no sample has come for `limit` seconds."""
        topic = self.source.topic
        for name, channel in self.channels.items():
            last = channel.last
            whole = len(self.channels) == 1 or self._advanced is None
            if last is None:
                return Unheard(self.label, topic) if whole else UnheardOf(self.label, name, topic)
            age = now - last.received
            if age > limit:
                return Old(self.label, age, topic) if whole else OldOf(self.label, name, age, topic)
        return None

    def trouble(self, now: float) -> Trouble | None:
        """Why the source cannot be believed now."""
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
        """Accept a new clock, as a person has looked at the machine."""
        self.new_clock = None

    def settle(self, now: float, stands: bool) -> None:
        """Accept a new clock once the machine has stood long enough by its stamps."""
        new_clock = self.new_clock
        if new_clock is not None and not stands:
            self.new_clock = max(new_clock[0], now), new_clock[1]
        elif new_clock is not None and now - new_clock[0] >= SETTLED:
            self.new_clock = None

    @property
    def surprised(self) -> float:
        """When a channel last was at a place that no motion leads to."""
        return max(channel.surprised for channel in self.channels.values())

    def moving(self) -> bool:
        """Whether any channel moved; unknown counts as moving."""
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
        if self._places is None:
            last = {name: channel.last for name, channel in self.channels.items()}
            self._places = {name: one.place for name, one in last.items() if one is not None and one.place}
        return self._places
