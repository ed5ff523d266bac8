"""Excavator and carrier on a piece of ground, driven by poses in virtual time: for the tests and the bench of soil."""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.links import Matrix, placed
from tms_soil.earth import Earth
from tms_soil.grid import Grid
from tms_soil.soils import Soil, SoilsFile
from tms_soil.surface import Heights


class Arm(NamedTuple):
    """Angles of a zx200 [rad]."""

    swing: float
    boom: float
    arm: float
    bucket: float


NAMES = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint")
SPEEDS = (1.0, 0.45, 1.0, 1.1)  # rad/s, the limits
START = Arm(-1.571, -1.047, 2.443, -0.524)  # initial_pose of the zx200's records
KINDS = np.array([[0, 1], [1, 0]], dtype=np.uint8)  # soil by tile of a random site
QUICK = 12  # reports from pose to pose
TURNS = [-1.55 + 0.3 * k for k in (0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6)]  # rad, where a truckload is dug
HOLD = (-0.9, 2.0, 1.7)  # boom, arm and bucket while it carries
ABOVE = Arm(0.0, -0.85, 1.65, 2.19)  # release_pose
OPEN = Arm(0.0, -1.0, 1.55, -0.34)


# The fundamental earthmoving equation, computed from the published formulas: density kg/m3, cohesion Pa, friction deg,
# steel deg; failure plane deg at a rake of 45 deg, factors of weight and cohesion.
VECTORS = {
    "earth of OperaSim-AGX": (1474, 2100, 40, 24, 29.3, 1.96, 2.35),
    "dry sand": (1500, 0, 34, 22, 31.9, 1.62, 2.14),
    "sandy loam": (1600, 5000, 30, 20, 33.8, 1.44, 2.00),
    "stiff clay": (1900, 40000, 15, 10, 42.3, 0.95, 1.55),
}
WIDTH = 1.05  # m
PLACES = ((45, 0.2), (45, 0.3), (45, 0.4), (60, 0.3))  # rake deg, depth m
FORCES = {  # kN at these places
    "earth of OperaSim-AGX": (2.2, 4.2, 6.8, 5.6),
    "dry sand": (1.0, 2.3, 4.0, 2.6),
    "sandy loam": (3.0, 5.3, 8.0, 6.6),
    "stiff clay": (13.8, 21.2, 29.0, 25.0),
}


def soil_of_vector(name: str) -> Soil:
    bank, cohesion, friction, steel, *_ = VECTORS[name]
    return soils()[0].model_copy(update={"bank": bank, "cohesion": cohesion, "friction": friction, "steel": steel})


class Report(NamedTuple):
    machine: str
    time: float
    angles: Mapping[str, float]
    base: Matrix


def model_of(name: str) -> MachineModel:
    return parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel)


def soils(*names: str) -> list[Soil]:
    known = parse(CONFIGS / "soils.yaml", SoilsFile).soils
    return [known[name] for name in names or ("earth",)]


def flat(side: float = 12.8, z: float = 0.0, cell: float = 0.2) -> Heights:
    """A level square around the origin of map."""
    count = math.ceil(side / cell - 1e-9)
    return Heights(-side / 2, -side / 2, cell, np.full((count, count), z))


def loading_site(side: float = 25.6, *kinds: str) -> Earth:
    """A zx200, and an ic120 beside it, below release_pose."""
    return Earth(Grid.from_heights(flat(side), soils(*kinds)), {"zx200": model_of("zx200"), "ic120": model_of("ic120")})


def moved(targets: Sequence[Arm], start: float = 0.0, rate: float = 50.0) -> Iterator[tuple[float, Arm]]:
    """Times and angles on the straight ways between poses, each joint at its speed at most."""
    time = start
    for here, there in itertools.pairwise(targets):
        seconds = max(0.1, *(abs(b - a) / v for a, b, v in zip(here, there, SPEEDS, strict=True)))
        count = max(1, round(seconds * rate))
        for k in range(1, count + 1):
            time += 1 / rate
            yield time, Arm(*(a + (b - a) * k / count for a, b in zip(here, there, strict=True)))


def dig_poses(turn: float = -1.58, boom: float = -0.25, arm: float = 1.97, now: Arm = START) -> list[Arm]:
    """A pass: over the place, with straight teeth about 0.9 m down, curled, up; all angles in rad."""
    reach = Arm(turn, boom, arm, -0.61)
    return [now, now._replace(swing=turn), reach, reach._replace(arm=arm + 0.1, bucket=1.7), Arm(turn, *HOLD)]


def reports(poses: Iterable[tuple[float, Arm]], base: Matrix | None = None) -> Iterator[Report]:
    """Of a zx200."""
    for time, pose in poses:
        yield Report("zx200", time, dict(zip(NAMES, pose, strict=True)), np.eye(4) if base is None else base)


def vessel(time: float, angle: float, base: Matrix | None = None) -> Report:
    """Of an ic120 whose vessel is below release_pose."""
    return Report("ic120", time, {"vessel_pin_joint": angle}, placed(6.5, 0.0, 0.0) if base is None else base)


def run(earth: Earth, log: Iterable[Report]) -> float:
    """Time of the last report."""
    time = 0.0
    for one in log:
        earth.report(one.machine, one.time, one.angles, one.base)
        time = one.time
    return time


def moved_by(earth: Earth, of: str) -> float:
    """Soil [kg] in a bucket or vessel."""
    load = earth.bodies[of].load
    assert load is not None
    return float(load.sum())


def truckload(earth: Earth) -> list[float]:
    """Dig around the excavator and dump into the ic120 until it is full: the volume of each pass [m3], loose."""
    digger, hauler, vessel_ = earth.bodies["zx200"].digger, earth.bodies["ic120"].hauler, model_of("ic120").vessel
    assert digger and hauler and vessel_
    earth.report(*vessel(0.0, 0.0))
    passes, time = list[float](), 0.0
    for turn in TURNS:
        time = run(earth, reports(moved([*dig_poses(turn, now=OPEN), ABOVE], time)))
        passes.append(digger.volume)
        time = run(earth, reports(moved([ABOVE, OPEN, OPEN, OPEN], time)))
        time = run(earth, reports((time + k / 50, OPEN) for k in range(1, 40)))
        if hauler.volume >= 0.97 * vessel_.heaped:
            break
    return passes


def random_site() -> Earth:
    """An excavator in a hollow, so that most poses of its arm dig."""
    models = {"zx200": model_of("zx200"), "ic120": model_of("ic120")}
    return Earth(Grid.from_heights(flat(25.6, z=0.8), soils("earth", "sand"), KINDS), models)


def mass_error(log: Iterable[Report]) -> float:
    """What a random site has lost or made by a log, as a share of what its machines had moved at least."""
    earth, most = random_site(), 100.0
    before = earth.mass()
    for one in log:
        earth.report(*one)
        most = max(most, moved_by(earth, "zx200") + moved_by(earth, "ic120"))
    return abs(earth.mass() - before) / most


def cycle_log(poses: Sequence[Arm], tilt: float, start: float) -> list[Report]:
    """Quickly through poses, while the vessel tips [rad] and the truck drives; the first pose is a jump."""
    found, time = list[Report](), start
    for number, (here, there) in enumerate(itertools.pairwise(poses)):
        for k in range(QUICK):
            time += 0.02
            share = k / (QUICK - 1)
            pose = Arm(*(a + (b - a) * share for a, b in zip(here, there, strict=True)))
            found += reports([(time, pose)])
            found.append(vessel(time, -tilt * share, placed(6.5 + 0.05 * k, 0.3 * number, 0.1)))
    return found


def cycles(count: int) -> st.SearchStrategy[list[Report]]:
    """Logs of so many random cycles; clocks go back and jump now and then."""
    pose = st.builds(Arm, st.floats(-3, 3), st.floats(-0.9, -0.1), st.floats(0.6, 2.6), st.floats(-0.6, 2.3))
    one = st.builds(cycle_log, st.lists(pose, min_size=3, max_size=4), st.floats(0, 1.1), st.floats(-5, 50))
    return st.lists(one, min_size=count, max_size=count).map(lambda logs: list(itertools.chain.from_iterable(logs)))
