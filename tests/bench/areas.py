"""How long the gateway's look at the areas takes, with as many and as large ones as a site may have: without processes.

Times are those of the processor, so that other programs do not count. Their floor is that of one question of the
geometry library of the same shapes.
"""

from __future__ import annotations

import math
import random
import time
from collections.abc import Iterable

import numpy as np
import shapely

from bench.runner import Figure
from tms_areas.areas import Area, AreaSet, Kind, ring
from tms_areas.body import Silhouette
from tms_areas.braking import tracks_of
from tms_areas.checks import AREAS, CORNERS
from tms_areas.fix import Motion, Seen
from tms_areas.guard import Guard
from tms_areas.law import Law
from tms_config.config import load_site

LOOKS, AGAIN = 1000, 5  # different ones, each so often in a row: on some PCs the clock takes half as long as a look
TRIES = 3  # of each: the least counts, as a PC whose speed changes within a second would be measured else
MOST = 2.0  # ms of a look, of 99 in 100
SITE, MACHINES = "drill", ("zx200", "ic120_1")
FAR = 200.0  # m to the border of the unmanned area
USUAL = 0.004  # ms, the floor on a usual PC
KINDS: tuple[Kind, ...] = ("blocked", "manned", "speed_limit")


def measure() -> Iterable[Figure]:
    areas, site = _areas(random.Random(1)), load_site(SITE)
    floor = _floor(areas)
    for machine in MACHINES:
        model = site.model_of(machine)
        silhouette = Silhouette(model)
        guard = Guard(Law(areas, machine, tracks_of(model, site.border(machine))), silhouette)
        times = np.sort(_looks(guard, dict.fromkeys(model.joints, 0.0), random.Random(2)))
        note = f"{AREAS} areas of {CORNERS} corners; mean {times.mean():.2f} ms, worst {times[-1]:.2f} ms"
        p99 = float(times[int(0.99 * len(times))])
        yield Figure(f"look at {machine}, p99", "ms", p99, MOST, floor, USUAL, note)


def _looks(guard: Guard, joints: dict[str, float], r: random.Random) -> np.ndarray:
    found = []
    for _ in range(LOOKS):
        x, y, yaw = r.uniform(-FAR, FAR), r.uniform(-FAR, FAR), r.uniform(-math.pi, math.pi)
        motion = Motion(x, y, yaw, r.uniform(-0.8, 0.8), r.uniform(-0.2, 0.2), r.uniform(-0.3, 0.3), 0.12, 0.05)
        found.append(min(_look(guard, motion, joints) for _ in range(TRIES)))
    return np.array(found)


def _look(guard: Guard, motion: Motion, joints: dict[str, float]) -> float:
    begun = time.thread_time()
    for _ in range(AGAIN):
        guard.look(Seen(None, motion), joints, tracks=True)
    return 1000 * (time.thread_time() - begun) / AGAIN


def _floor(areas: AreaSet) -> float:
    """Whether a small square is in the largest area."""
    whole, square = areas.of("unmanned")[0].polygon, shapely.box(0, 0, 2, 2)
    shapely.prepare(whole)
    begun = time.thread_time()
    for _ in range(LOOKS):
        shapely.contains(whole, square)
    return 1000 * (time.thread_time() - begun) / LOOKS


def _areas(r: random.Random) -> AreaSet:
    found = [_round(r, "border", "unmanned", 0.0, 0.0, FAR)]
    for number in range(1, AREAS):
        x, y = r.uniform(-0.7 * FAR, 0.7 * FAR), r.uniform(-0.7 * FAR, 0.7 * FAR)
        found.append(_round(r, f"area{number}", KINDS[number % len(KINDS)], x, y, r.uniform(2.0, 8.0)))
    return AreaSet(tuple(found))


def _round(r: random.Random, name: str, kind: Kind, x: float, y: float, radius: float) -> Area:
    corners = []
    for turn in np.linspace(0.0, math.tau, CORNERS, endpoint=False).tolist():
        far = radius * r.uniform(0.9, 1.1)
        corners.append((x + far * math.cos(turn), y + far * math.sin(turn)))
    return Area(name, kind, ring(corners), speed=1.0 if kind == "speed_limit" else None)
