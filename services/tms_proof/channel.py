"""One quantity of a machine, such as a joint's angle or the place of its base, and whether it moved. Pure logic."""

import itertools
import math
from dataclasses import dataclass

from tms_proof.reasons import PositionsMove, VelocitiesMove
from tms_reason.reason import Reason

WORST = 0.3  # s; the highest speed within this time counts, not the last message
KEPT = 1.2  # s of samples
SPAN = 0.8  # share of WORST that samples must span before positions and velocities are compared
HIDES = 0.25  # s of the machine between two samples in which a whole motion may be hidden: it begins and ends at rest
CLEARLY = 2.0  # times the limit: below it, positions and velocities may disagree on whether there is a motion
SPEED_MARGIN = 1.5  # times its top speed: no motion goes further from one sample to the next
BETWEEN = 0.004  # rad or m that a motion may differ from what the velocities at both its ends allow ...
JITTER = 0.025  # s, ... and as far as it goes in this time: drivers stamp what they have measured a little earlier

Place = tuple[float, ...]  # rad, or m; empty where only a speed is reported


@dataclass(frozen=True)
class Limits:
    """When the quantity counts as standing."""

    speed: float  # rad/s or m/s, of the machine's own time
    top: float = float("inf")  # rad/s or m/s, its top speed
    resolution: float = 0.0  # rad or m by which positions jitter
    turns: bool = False  # an angle that may wrap
    scale: float = 1.0  # seconds of the machine in one second: the speed of a stand-in
    longest: float = float("inf")  # s between two samples; a jump is hidden in a longer gap


@dataclass(frozen=True)
class ChannelSample:
    """One sample; times are seconds of the receiver's monotonic clock."""

    received: float
    stamped: float  # when it was measured, by its stamp
    place: Place
    speed: float | None  # rad/s or m/s, as the message gives it
    fast: bool  # it showed a motion, by its speed or against the sample before


class Channel:
    """One thread adds samples in order of time, any thread reads."""

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        # Replaced at each sample, not changed: other threads read it without a lock.
        self._samples: tuple[ChannelSample, ...] = ()
        self._recent: tuple[ChannelSample, ...] = ()  # of the last moments
        # What was concluded from these samples: most of them are looked at many times.
        self._moves: bool | None = None
        self._disagrees: tuple[Reason | None, ...] = ()
        self.surprised = float("-inf")  # when it last was at a place that no motion leads to, as in a replayed record

    @property
    def last(self) -> ChannelSample | None:
        """The newest sample."""
        samples = self._samples
        return samples[-1] if samples else None

    def add(self, received: float, stamped: float, place: Place, speed: float | None) -> None:
        """Take one sample."""
        before = self.last
        fast = speed is not None and abs(speed) >= self._limits.speed
        fast = fast or (before is not None and self._moved(before.received, before.stamped, before.place,
                                                           received, stamped, place))  # fmt: skip
        if before is not None and before.place and self._leaps(before, stamped - before.stamped, place, speed):
            self.surprised = received
        samples, first = self._samples, 0
        while first < len(samples) and received - samples[first].received > KEPT:
            first += 1
        self._take((*samples[first:], ChannelSample(received, stamped, place, speed, fast)))

    def clear(self) -> None:
        """Forget everything: what was received belongs to another clock."""
        self._take(())

    def _take(self, samples: tuple[ChannelSample, ...]) -> None:
        self._samples, self._moves, self._disagrees = samples, None, ()
        first = len(samples)
        while first > 0 and samples[-1].received - samples[first - 1].received <= WORST + 1e-9:
            first -= 1
        self._recent = samples[first:]

    def moving(self) -> bool:
        """Whether any of the last samples showed a motion; unknown counts as moving."""
        if self._moves is None:
            self._moves = self._moving()
        return self._moves

    def _moving(self) -> bool:
        recent = self._recent
        if len(recent) < 2:
            return True
        first, last = recent[0], recent[-1]
        return any(one.fast for one in recent) or self._moved(
            first.received, first.stamped, first.place, last.received, last.stamped, last.place
        )

    @property
    def evident(self) -> bool:
        """Whether the newest sample shows a motion that went so far that a jump back to its begin would be noticed."""
        samples = self._samples
        if not samples or not samples[-1].fast or not samples[-1].place:
            return False
        begun = max((i for i, one in enumerate(samples) if not one.fast), default=0)
        speed = max(abs(one.speed or 0.0) for one in samples[begun:])
        return self._distance(samples[begun].place, samples[-1].place) > self._spare(speed)

    def stood_since(self, start: float, seconds: float) -> bool:
        """Whether samples received and measured after `start` span `seconds` of standing, up to the newest."""
        if self.moving():
            return False
        after = [one for one in self._samples if one.received > start and one.stamped > start]
        fast = max((i for i, one in enumerate(after) if one.fast), default=-1)
        still = after[fast + 1 :]
        if len(still) < 2:
            return False
        first, last = still[0], still[-1]
        return min(last.received - first.received, last.stamped - first.stamped) >= seconds

    def disagreement(self) -> Reason | None:
        """Which of position and velocity shows a motion while the other shows none; None if they agree."""
        if not self._disagrees:
            self._disagrees = (self._disagreement(),)
        return self._disagrees[0]

    def _disagreement(self) -> Reason | None:
        recent = self._recent
        if not recent or not recent[0].place or recent[-1].received - recent[0].received < SPAN * WORST:
            return None
        reported = [abs(one.speed) for one in recent if one.speed is not None]
        if len(reported) < len(recent):
            return None
        first, last, limit = recent[0], recent[-1], self._limits.speed
        seconds = last.stamped - first.stamped
        if seconds <= 0 or self._hidden(recent):
            return None
        away, seconds = self._way(first, last), seconds * self._limits.scale
        if away / seconds > CLEARLY * limit and max(reported) < limit:
            return PositionsMove()
        # The way and not how far it came: a joint that turns back is soon where it was.
        gone = sum(itertools.starmap(self._way, itertools.pairwise(recent)))
        if min(reported) > CLEARLY * limit and gone / seconds < limit:
            return VelocitiesMove()
        return None

    def _way(self, before: ChannelSample, after: ChannelSample) -> float:
        """How far it went at least between two samples [rad or m]."""
        return max(0.0, self._distance(before.place, after.place) - self._limits.resolution)

    def _hidden(self, samples: tuple[ChannelSample, ...]) -> bool:
        """Whether messages are missing between samples, or a stand-in is too fast for its period."""
        gaps = (after.stamped - before.stamped for before, after in itertools.pairwise(samples))
        return any(gap * self._limits.scale > HIDES for gap in gaps)

    def _moved(self, received: float, stamped: float, place: Place, then: float, measured: float, now: Place) -> bool:
        """Whether the way between two samples is longer than a standing machine may have gone."""
        seconds = max(0.0, min(then - received, measured - stamped)) * self._limits.scale
        return self._distance(place, now) > self._limits.speed * seconds + self._limits.resolution + 1e-9

    def _leaps(self, before: ChannelSample, seconds: float, place: Place, speed: float | None) -> bool:
        """Whether no motion leads from one sample to the next."""
        limits, way = self._limits, self._distance(before.place, place)
        if seconds > limits.longest and way > self._spare(0.0):
            return True
        seconds, spare = seconds * limits.scale, self._spare(max(abs(speed or 0.0), abs(before.speed or 0.0)))
        if way > SPEED_MARGIN * limits.top * seconds + spare:
            return True
        if speed is None or before.speed is None or seconds > WORST / 2 * limits.scale:
            return False
        if len(place) == 1:  # the direction of the speed counts, too
            way = math.remainder(place[0] - before.place[0], math.tau) if limits.turns else place[0] - before.place[0]
            speeds = before.speed, speed
        else:
            speeds = abs(before.speed), abs(speed)
        return not min(speeds) * seconds - spare <= way <= max(speeds) * seconds + spare

    def _spare(self, speed: float) -> float:
        """How far two samples may be off the motion between them [rad or m]."""
        return self._limits.resolution + BETWEEN + JITTER * self._limits.scale * speed

    def _distance(self, a: Place, b: Place) -> float:
        return distance(a, b, self._limits.turns)


def distance(a: Place, b: Place, turns: bool = False) -> float:
    """How far two positions are apart [rad or m]; angles that turn are apart by the shorter way."""
    if turns:
        return abs(math.remainder(b[0] - a[0], math.tau))
    return math.dist(a, b)
