"""How fast the ground follows the machines, and how true it is: in virtual time, without processes.

Times are those of the processor, so that other programs do not count. Their floor is the kinematics of the same poses
alone.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from typing import Any

import numpy as np
from hypothesis import HealthCheck, Phase, given, settings

from bench.runner import Figure
from earth_rig import (
    ABOVE,
    FORCES,
    OPEN,
    PLACES,
    START,
    TURNS,
    VECTORS,
    WIDTH,
    Report,
    cycles,
    dig_poses,
    flat,
    loading_site,
    mass_error,
    model_of,
    moved,
    moved_by,
    reports,
    run,
    soil_of_vector,
    soils,
    truckload,
    vessel,
)
from tms_control.links import Links, placed
from tms_soil.cutting import put_down
from tms_soil.earth import Earth
from tms_soil.grid import FINE, TILE, Grid
from tms_soil.resistance import factors, force
from tms_soil.slumping import settle

CYCLES, AT_ONCE = 1000, 4  # random cycles, on one ground
PASSES = 4  # of which each update is timed
RATE = 25.0  # Hz of the reports of a site
USUAL = 0.06  # ms, kinematics of a pose on a usual PC
ROUNDING = 0.05  # kN of the published forces


def measure() -> Iterable[Figure]:
    updates, floors = _updates()
    usual = float(np.mean(floors))
    yield Figure("update mean", "ms", float(np.mean(updates)), 1.0, usual, usual_floor=USUAL)
    yield Figure("update p99", "ms", float(np.percentile(updates, 99)), 3.0, usual, usual_floor=USUAL)
    yield Figure("update of a machine that rests", "ms", _resting(), 0.3, usual, usual_floor=USUAL)
    yield Figure(
        "two diggers, three carriers", "%", _busy_site(), 40.0, usual * 5 * RATE / 10, usual_floor=USUAL * 5 * RATE / 10
    )
    yield Figure("200 m x 200 m, dug all over", "MB", _memory(), 150.0, flat(200.0).z.nbytes / 1e6)
    yield Figure(f"mass error of {CYCLES} random cycles", "", _mass_error(), 1e-9)
    yield Figure("piles off their repose after 5 s", "deg", _repose(), 1.0)
    yield Figure("test vectors of the resistance", "", _vectors(), 0.02)
    volumes = truckload(loading_site())
    worst = max(volumes[:-1], key=lambda volume: abs(volume - 0.7))
    yield Figure("bucket, from 0.7 m3", "m3", abs(worst - 0.7), 0.2, note=f"{worst:.2f} m3")
    yield Figure("passes that fill an ic120, from 8", "", abs(len(volumes) - 8), 1.0, note=str(len(volumes)))
    yield Figure("cells that differ for the same log", "", _differing(), 0.0)
    yield Figure("loads off at ten times the speed", "", _off_at_speed(), 0.03)


def _log(rate: float = 50.0) -> list[Report]:
    poses = [OPEN]
    for turn in TURNS[:PASSES]:
        poses += dig_poses(turn, now=poses[-1])[1:]
        poses += [ABOVE, OPEN]
    return [vessel(0.0, 0.0), *reports(moved(poses, rate=rate))]


def _updates() -> tuple[list[float], list[float]]:
    """Milliseconds of each update at 50 Hz while an excavator loads a truck, and of the kinematics alone."""
    earth, links = loading_site(), Links(model_of("zx200"), ["bucket_link"])
    updates, floors = [], []
    for one in _log():
        pose = np.array([[one.angles.get(joint, 0.0) for joint in links.names]])
        begun = time.thread_time()
        links.places(pose)
        between = time.thread_time()
        earth.report(*one)
        updates.append((time.thread_time() - between) * 1000)
        floors.append((between - begun) * 1000)
    assert moved_by(earth, "ic120") > 1000.0, "it digs and loads"
    return updates, floors


def _resting() -> float:
    """The median of the updates of an excavator that has stood for a while."""
    earth, times = loading_site(), []
    end = run(earth, reports(moved(dig_poses())))
    last = dig_poses()[-1]
    for one in reports((end + 0.02 * k, last) for k in range(1, 400)):
        begun = time.thread_time()
        earth.report(*one)
        times.append((time.thread_time() - begun) * 1000)
    return float(np.median(times[200:]))


def _busy_site() -> float:
    """Share of a core [%] for five machines that all work, at real speed; without ROS."""
    models = {
        name: model_of(name.partition("_")[0]) for name in ("zx200_1", "zx200_2", "ic120_1", "ic120_2", "ic120_3")
    }
    earth = Earth(Grid.from_heights(flat(51.2), soils()), models)
    arms = [one.angles for one in reports(moved([*dig_poses(), ABOVE, OPEN, START], rate=RATE))]
    begun = time.thread_time()
    for k, angles in enumerate(arms):
        now = k / RATE
        for number in (1, 2):
            earth.report(f"zx200_{number}", now, angles, placed(0.0, 18.0 * number - 27.0, 0.0))
        for number in (1, 2, 3):
            place = placed(6.5 - 0.8 * now * (number > 1), 9.0 * number - 18.0, 0.0)
            earth.report(f"ic120_{number}", now, {"vessel_pin_joint": -0.05 * now}, place)
    return 100 * (time.thread_time() - begun) / (len(arms) / RATE)


def _memory() -> float:
    grid = Grid.from_heights(flat(200.0), soils())
    x0, y0, x1, y1 = grid.bounds
    for x in np.arange(x0, x1, TILE):
        for y in np.arange(y0, y1, TILE):
            grid.window((x + 1, y + 1, x + 2, y + 2))
    return grid.bytes / 1e6


def _mass_error() -> float:
    """The largest error of all cycles, as a share of what bucket and vessel had in at most."""
    worst = 0.0

    @settings(
        max_examples=CYCLES // AT_ONCE, deadline=None, database=None, derandomize=True,
        suppress_health_check=list(HealthCheck), phases=[Phase.generate],
    )  # fmt: skip
    @given(cycles(AT_ONCE))
    def balance(log: list[Report]) -> None:
        nonlocal worst
        worst = max(worst, mass_error(log))

    balance()
    return worst


def _repose() -> float:
    worst = 0.0
    for kind, mass in (("earth", 5000.0), ("sand", 3000.0), ("clay", 2000.0)):
        soil = soils(kind)[0]
        grid = Grid.from_heights(flat(), [soil])
        put_down(grid, np.array([[-0.3, -0.3, 0], [0.3, -0.3, 0]]), np.array([0.0, 0.6]), mass)
        for _ in range(250):
            window = grid.window((-3.2, -3.2, 3.2, 3.2))
            assert window is not None
            settle(window)
            grid.store(window)
        z: Any = window.heights()
        slope = np.hypot(z[1:-1, 2:] - z[1:-1, :-2], z[2:, 1:-1] - z[:-2, 1:-1]) / (2 * FINE)
        worst = max(worst, math.degrees(math.atan(slope.max())) - soil.repose)
    return max(worst, 0.0)


def _vectors() -> float:
    """The largest relative error of factors and forces, beyond the rounding of the latter."""
    worst = 0.0
    for name, (*_, plane, weight, stuck) in VECTORS.items():
        soil = soil_of_vector(name)
        found = factors(soil, math.radians(45))
        pairs = [(math.degrees(found.plane), plane), (found.weight, weight), (found.cohesion, stuck)]
        worst = max(worst, *(abs(one / wanted - 1) for one, wanted in pairs))
        for (rake, depth), wanted in zip(PLACES, FORCES[name], strict=True):
            off = abs(force(soil, math.radians(rake), WIDTH, np.array([depth])) / 1e3 - wanted) - ROUNDING
            worst = max(worst, off / wanted)
    return worst


def _off_at_speed() -> float:
    """How far loads are off when machines tell their joints a tenth as often in their own time."""
    once, fast = (loading_site() for _ in range(2))
    run(once, _log())
    run(fast, _log(rate=5.0))
    return abs(moved_by(fast, "ic120") / moved_by(once, "ic120") - 1)


def _differing() -> int:
    first, second = (loading_site() for _ in range(2))
    for earth in (first, second):
        run(earth, _log())
    return int(np.count_nonzero(first.grid.heights().z != second.grid.heights().z))
