"""Where an excavator digs next: the place, depth and drag that bring most soil for the time that they take.

Candidates are drags in the plane of the arm: down at a distance, a way towards the machine, up. What a drag brings is
estimated from the ground as it is now, never deeper than the design.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tms_config.models import Bucket
from tms_soil.surface import Array, Heights, Mask, Point, distance, inside

TURN = math.radians(5)  # rad between two directions
STEP = 0.25  # m between two places on a line
ARM = 0.3  # m beside the bucket in which the ground must be low enough for the arm
CURLS = 0.75  # m of a line over which the opening gathers when the bucket curls
LINES = 5  # lines side by side on which a bucket looks at the ground
DEPTHS = (0.3, 0.5, 0.7, 0.9, 1.1)  # m; deeper, a full bucket could not curl below the arm
DRAGS = (0.0, 0.5, 1.0, 1.5, 2.0)  # m
CLEAR = 0.5  # m between a bucket that digs and what it must not touch
NEAR, SHALLOWER = 0.8, 0.3  # m between drags that differ
LEAST = 0.1  # m3 loose, of the bucket; what brings less is not worth a swing
FIXED = 14.0  # s of a cycle without its turns and drag: the measured 25.9 s at 90 degrees, less these
SWINGS = 0.35  # rad/s of a turn with its beginning and end: 90 degrees there and back in about 9 s
DRAGGING = 0.6  # m/s: the planner's speed through soil
LOOSENS = 1.1  # loose volume in the bucket by volume that the edge passes: the swell, less what falls back


class Stand(NamedTuple):
    """Where a machine stands, in map."""

    x: float  # m
    y: float  # m
    z: float  # m, below its tracks
    yaw: float  # rad


@dataclass(frozen=True)
class Digging:
    """What one machine digs with, and where it may: distances are from its origin, in the plane of the ground."""

    width: float  # m, of the bucket
    opening: float  # m, from its rear lip to the cutting edge
    holds: float  # m3 loose, when it was filled in the ground
    near: float  # m, no edge comes nearer
    far: float  # m, nor goes further out
    deepest: float  # m below the tracks, nor goes deeper

    @classmethod
    def of(cls, bucket: Bucket, holds: float, near: float, far: float, deepest: float) -> "Digging":
        """With a bucket."""
        return cls(bucket.width, math.dist(bucket.section[0], bucket.section[-1]), holds, near, far, deepest)


@dataclass(frozen=True)
class DigPoint:
    """One drag; where its edge goes down, in base_link."""

    x: float  # m
    y: float  # m
    z: float  # m, the ground there
    depth: float  # m below it
    drag: float  # m towards the machine
    loose: float  # m3 that it should bring
    benefit: float  # m3 loose by second of a cycle

    def like(self, other: "DigPoint") -> bool:
        """Whether an arm that cannot do the other one hardly can do this one: near it, and about as low."""
        low, others = self.z - self.depth, other.z - other.depth  # a ridge beside a hole is no place like the hole
        return math.hypot(self.x - other.x, self.y - other.y) < NEAR and low < others + SHALLOWER


def dig_points(
    ground: Heights, design: Heights, stand: Stand, tool: Digging, allowed: Sequence[Point],
    taken: Sequence[Sequence[Point]], swing: float,
) -> list[DigPoint]:  # fmt: skip
    """Drags at each place and to each depth, the best first; none where nothing is left to dig.

    Args:
        ground: heights now.
        design: heights that may be reached, on the same cells; NaN: there nothing is to be dug.
        stand: the machine.
        tool: its bucket.
        allowed: corners of the polygon in which it may dig [m, map].
        taken: polygons that other machines stand on [m, map].
        swing: direction in which the load goes [rad, base_link]: what is nearer to it costs less time.
    """
    bearings = np.arange(0.0, math.tau, TURN)
    out = np.arange(tool.near, tool.far + 1e-9, STEP)
    x, y = _places(stand, bearings, out)
    free = inside(allowed, x, y) if out.size else np.zeros(x.shape, np.bool_)
    for polygon in taken:
        free &= ~inside(polygon, x, y) & (distance(polygon, x, y) > tool.width / 2 + CLEAR)
    surface, floor = _profiles(ground, design, stand, bearings, out, tool.width)
    floor = np.maximum(floor, -tool.deepest)
    free &= np.isfinite(surface) & np.isfinite(floor)
    found: list[DigPoint] = []
    for k in np.flatnonzero(free.any(axis=1)):
        turn = abs(math.remainder(float(bearings[k]) - swing, math.tau))
        seconds = FIXED + 2 * turn / SWINGS
        found += _in_line(out, surface[k], floor[k], free[k], float(bearings[k]), seconds, tool)
    return sorted(found, key=lambda one: -one.benefit)


def _places(stand: Stand, bearings: Array, out: Array, aside: float = 0.0) -> tuple[Array, Array]:
    """Places in map [m], by bearing and distance, `aside` [m] to the left of the line."""
    c, s = np.cos(bearings + stand.yaw)[:, None], np.sin(bearings + stand.yaw)[:, None]
    return stand.x + c * out - s * aside, stand.y + s * out + c * aside


def _profiles(
    ground: Heights, design: Heights, stand: Stand, bearings: Array, out: Array, width: float
) -> tuple[Array, Array]:
    """The ground's mean height over the bucket's width, and how low an edge may come there, from the tracks' level [m].

    Not below the design, nor so deep below the highest ground around that the arm would touch that. Both by bearing and
    distance; NaN where one is not known over all of the width.
    """
    surfaces, designs = [], []
    for aside in (np.arange(LINES) + 0.5) / LINES * width - width / 2:
        x, y = _places(stand, bearings, out, float(aside))
        surfaces.append(ground.at(x, y))
        designs.append(design.at(x, y))
    edges = [ground.at(*_places(stand, bearings, out, side * (width / 2 + ARM))) for side in (-1.0, 1.0)]
    across = np.fmax.reduce([*surfaces, *edges])
    reach = round(CURLS / STEP)
    around = np.pad(across, ((0, 0), (reach, reach)), mode="edge")
    highest = np.max([around[:, k : k + across.shape[1]] for k in range(2 * reach + 1)], axis=0)
    # NaN stays NaN, as nothing is to be dug where the design says nothing.
    return np.mean(surfaces, axis=0) - stand.z, np.maximum(np.max(designs, axis=0), highest - DEPTHS[-1]) - stand.z


def _in_line(
    out: Array, surface: Array, floor: Array, free: Mask, bearing: float, seconds: float, tool: Digging
) -> list[DigPoint]:
    """Those of one direction: at each place and to each depth the drag that brings most for its time."""
    best: dict[tuple[int, float], DigPoint] = {}
    for drag in DRAGS:
        cells = round(drag / STEP)
        for j in range(cells, len(out)):
            part = slice(j - cells, j + 1)
            if not free[part].all():
                continue
            took = seconds + drag / DRAGGING
            for depth in _depths(float(surface[j] - floor[part].max())):
                loose = _brings(surface, j - cells, j, float(surface[j]) - depth, tool)
                other = best.get((j, depth))
                if loose >= LEAST and (other is None or loose / took > other.benefit + 1e-9):
                    at = float(out[j]) * math.cos(bearing), float(out[j]) * math.sin(bearing)
                    best[j, depth] = DigPoint(*at, float(surface[j]), depth, drag, loose, loose / took)
    return list(best.values())


def _depths(room: float) -> list[float]:
    """Depths [m] that stay above the floor; the last one reaches it, if it is that near."""
    found = [depth for depth in DEPTHS if depth < room]
    return [*found, room] if 0.0 < room <= DEPTHS[-1] else found


def _brings(surface: Array, near: int, far: int, level: float, tool: Digging) -> float:
    """Loose soil [m3] in the bucket after a drag at a level [m] from the place `far` to `near`.

    What its edge passes, as far as the ground holds it in: as much of the opening is below the ground where it curls.
    """
    first = max(0, near - round(CURLS / STEP))
    passed = np.maximum(surface[first : far + 1] - level, 0.0)
    swept = LOOSENS * tool.width * STEP * float(passed.sum())
    covered = min(1.0, float(passed[: near - first + 1].mean()) / tool.opening)
    return min(swept, tool.holds * covered)
