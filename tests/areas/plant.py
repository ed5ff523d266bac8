"""Tracks as they truly move, and a localisation that is late, drifts, is lost, jumps, or tells the same again."""

import math
import random
from collections import deque
from dataclasses import dataclass, field

STEP = 0.01  # s


@dataclass
class Ground:
    """How tracks grip: their speed becomes this share of itself, and some of it goes aside. Both change slowly."""

    random: random.Random
    grip: float = 1.0
    aside: float = 0.0
    until: float = 0.0

    def at(self, now: float, worst: float) -> tuple[float, float]:
        if now >= self.until:
            self.grip, self.aside = self.random.uniform(1.0 - worst, 1.0), self.random.uniform(-0.1, 0.1) * worst
            self.until = now + self.random.uniform(1.0, 5.0)
        return self.grip, self.aside


@dataclass
class Plant:
    """A machine on tracks: commands act a dead time later, through a lag."""

    ground: Ground
    slip: float  # largest share of speed that is lost
    dead_time: float  # s
    lag: float  # s
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    v: float = 0.0  # m/s of the tracks
    w: float = 0.0  # rad/s
    now: float = 0.0
    coming: deque[tuple[float, float, float]] = field(default_factory=deque)  # when, v, w
    wanted: tuple[float, float] = (0.0, 0.0)

    def command(self, v: float, w: float, late: float = 0.0) -> None:
        self.coming.append((self.now + self.dead_time + late, v, w))

    def step(self) -> None:
        self.now += STEP
        while self.coming and self.coming[0][0] <= self.now:
            _, *wanted = self.coming.popleft()
            self.wanted = wanted[0], wanted[1]
        share = -math.expm1(-STEP / self.lag)
        self.v += (self.wanted[0] - self.v) * share
        self.w += (self.wanted[1] - self.w) * share
        grip, aside = self.ground.at(self.now, self.slip)
        forward, left = self.v * grip, self.v * aside
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        self.x += (c * forward - s * left) * STEP
        self.y += (s * forward + c * left) * STEP
        self.yaw += self.w * grip * STEP


Pose = tuple[float, float, float]
TROUBLES = ("lost", "jump", "stuck", "nan")


@dataclass
class Trouble:
    """What is wrong with the localisation for a while."""

    kind: str
    begins: float
    ends: float
    dx: float
    dy: float
    turn: float


@dataclass
class Localisation:
    """Poses of the plant as a gateway gets them."""

    random: random.Random
    period: float  # s
    delay: float  # s from measuring to arrival
    noise: float  # m
    drift: float  # m, how far off it may be for long
    troubles: list[Trouble]
    phase: float
    due: float = 0.0
    under_way: deque[tuple[float, Pose]] = field(default_factory=deque)
    last: Pose = (0.0, 0.0, 0.0)
    right_at: float = 0.0  # when it last told where the machine was

    def take(self, now: float, true: Pose) -> list[tuple[float, Pose]]:
        """Measure if it is time; returns what has arrived, and when."""
        if now >= self.due:
            self.due = now + self.period * self.random.uniform(0.8, 1.2)
            told = self._told(now, true)
            if told is not None:
                arrives = now + self.delay * self.random.uniform(0.5, 1.0)
                if not self.under_way or arrives > self.under_way[-1][0]:
                    self.under_way.append((arrives, told))
        found = []
        while self.under_way and self.under_way[0][0] <= now:
            found.append(self.under_way.popleft())
        return found

    def _told(self, now: float, true: Pose) -> Pose | None:
        x = true[0] + self.drift * math.sin(0.1 * now + self.phase) + self.random.gauss(0.0, self.noise)
        y = true[1] + self.drift * math.cos(0.1 * now + self.phase) + self.random.gauss(0.0, self.noise)
        yaw = true[2] + self.random.gauss(0.0, self.noise / 4)
        for one in self.troubles:
            if one.begins <= now < one.ends:
                if one.kind == "lost":
                    return None
                if one.kind == "stuck":
                    return self.last
                if one.kind == "nan":
                    return (math.nan, y, yaw)
                x, y, yaw = x + one.dx, y + one.dy, yaw + one.turn
        if not any(one.begins <= now < one.ends for one in self.troubles):
            self.right_at = now
        self.last = (x, y, yaw)
        return self.last
