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
from tms_rp.kinds.backhoe.goals import TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_soil.earth import Earth
from tms_soil.grid import Grid
from tms_soil.soils import Soil, SoilsFile
from tms_soil.surface import Heights

NAMES = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint")
SPEEDS = (1.0, 0.45, 1.0, 1.1)  # rad/s, the limits
START = ArmAngles(-1.571, -1.047, 2.443, -0.524)  # initial_pose of the zx200's records
KINDS = np.array([[0, 1], [1, 0]], dtype=np.uint8)  # soil by tile of a random site
QUICK = 12  # reports from pose to pose
HOLD = (-0.9, 2.0, 1.7)  # boom, arm and bucket while it carries
ABOVE = ArmAngles(0.0, -0.85, 1.65, 2.19)  # release_pose
OPEN = ArmAngles(0.0, -1.0, 1.55, -0.34)


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


def moved(targets: Sequence[ArmAngles], start: float = 0.0, rate: float = 50.0) -> Iterator[tuple[float, ArmAngles]]:
    """Times and angles on the straight ways between poses, each joint at its speed at most."""
    time = start
    for here, there in itertools.pairwise(targets):
        seconds = max(0.1, *(abs(b - a) / v for a, b, v in zip(here, there, SPEEDS, strict=True)))
        count = max(1, round(seconds * rate))
        for k in range(1, count + 1):
            time += 1 / rate
            yield time, ArmAngles(*(a + (b - a) * k / count for a, b in zip(here, there, strict=True)))


def dig_poses(point: tuple[float, float, float], theta_w: float = 0.0, now: ArmAngles = START) -> list[ArmAngles]:
    """A pass as the planner makes it: to a point of base_link 1 m above where it digs, in, curled, up."""
    moves = Backhoe(model_of("zx200")).excavate(now, TipGoal(*point, theta_w))
    targets = [ArmAngles(*target) for target in moves.targets]
    return [now, *targets, ArmAngles(targets[-1].swing, *HOLD)]


def reports(poses: Iterable[tuple[float, ArmAngles]], base: Matrix | None = None) -> Iterator[Report]:
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


SPOTS = [(-6.0, -1.55 + 0.3 * k) for k in (0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6)]  # m and rad around the swing axis


def truckload(earth: Earth) -> list[float]:
    """Dig around the excavator and dump into the ic120 until it is full: the volume of each pass [m3], loose."""
    digger, hauler, vessel_ = earth.bodies["zx200"].digger, earth.bodies["ic120"].hauler, model_of("ic120").vessel
    assert digger and hauler and vessel_
    earth.report(*vessel(0.0, 0.0))
    passes, time = list[float](), 0.0
    for away, turn in SPOTS:
        point = -away * math.cos(turn), -away * math.sin(turn), 0.1
        time = run(earth, reports(moved([*dig_poses(point, now=OPEN), ABOVE], time)))
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


def cycle_log(poses: Sequence[ArmAngles], tilt: float, start: float) -> list[Report]:
    """Quickly through poses, while the vessel tips [rad] and the truck drives; the first pose is a jump."""
    found, time = [], start
    for number, (here, there) in enumerate(itertools.pairwise(poses)):
        for k in range(QUICK):
            time += 0.02
            share = k / (QUICK - 1)
            pose = ArmAngles(*(a + (b - a) * share for a, b in zip(here, there, strict=True)))
            found += reports([(time, pose)])
            found.append(vessel(time, -tilt * share, placed(6.5 + 0.05 * k, 0.3 * number, 0.1)))
    return found


def cycles(count: int) -> st.SearchStrategy[list[Report]]:
    """Logs of so many random cycles; clocks go back and jump now and then."""
    pose = st.builds(ArmAngles, st.floats(-3, 3), st.floats(-0.9, -0.1), st.floats(0.6, 2.6), st.floats(-0.6, 2.3))
    one = st.builds(cycle_log, st.lists(pose, min_size=3, max_size=4), st.floats(0, 1.1), st.floats(-5, 50))
    return st.lists(one, min_size=count, max_size=count).map(lambda logs: list(itertools.chain.from_iterable(logs)))
