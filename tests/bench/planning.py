"""How long an excavator's planner needs from a goal to a checked trajectory, and what it weighs.

500 random places to dig around the machine, between two trucks. The floor of the time is the kinematics alone; that
of the memory a process that has only imported rclpy.
"""

from __future__ import annotations

import contextlib
import math
import random
import subprocess
import sys
import time
from collections.abc import Callable, Iterable

from bench.runner import PROJECT, Figure
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_reason.errors import SubtaskFailed
from tms_rp.clearance import Clearance, Obstacle, placed
from tms_rp.kinds.backhoe.goals import TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.reasons import PartOf
from tms_rp.trajectory import trajectory

GOALS = 500
NOW = ArmAngles(0.0, -0.8029, 1.9897, 0.8029)
MEMORY = """
import re, pathlib, sys
sys.path[:0] = ["services", "tests"]
import rclpy
if sys.argv[1] == "all":
    import tms_rp.kinds.backhoe
    import tms_rp.node
    from bench.planning import plan_all
    plan_all()
print(re.search(r"VmHWM:\\s+(\\d+)", pathlib.Path("/proc/self/status").read_text())[1])
"""


def measure() -> Iterable[Figure]:
    times, floors = plan_all()
    assert len(times) > GOALS / 10, "hardly any of the places can be reached"
    yield Figure("goal p99", "ms", p99(times), 50.0, p99(floors), usual_floor=3.0)
    yield Figure("memory", "MB", megabytes("all"), 150.0, megabytes("rclpy"))


def plan_all() -> tuple[list[float], list[float]]:
    """Milliseconds of each goal that was planned to its end, and of its kinematics."""
    model = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
    truck = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
    backhoe, clearance, rng = Backhoe(model), Clearance(model), random.Random(1)
    obstacles = [
        Obstacle(PartOf(part, f"ic120_{i}"), box, placed(x, y, math.pi / 2))
        for i, (x, y) in enumerate(((8.0, 3.0), (-7.0, -2.0)))
        for part, box in truck.footprint.items()
    ]
    times, floors = [], []
    for _ in range(GOALS):
        away, turn = rng.uniform(4, 8), rng.uniform(-math.pi, math.pi)
        goal = TipGoal(away * math.cos(turn), away * math.sin(turn), rng.uniform(-1, 2), rng.uniform(0, 2))
        kinematics = clock(lambda goal=goal: backhoe.excavate(NOW, goal))
        begun = time.perf_counter()
        with contextlib.suppress(SubtaskFailed):  # out of reach, or a truck is in the way: planned all the same
            moves = backhoe.excavate(NOW, goal)
            made = trajectory(model.joints, (*NOW, 0.0), [(*pose, 0.0) for pose in moves.targets])
            floors.append(kinematics)
            clearance.check(made, obstacles)
        if len(floors) > len(times):
            times.append((time.perf_counter() - begun) * 1000)
    return times, floors


def clock(work: Callable[[], object]) -> float:
    begun = time.perf_counter()
    with contextlib.suppress(SubtaskFailed):
        work()
    return (time.perf_counter() - begun) * 1000


def p99(values: list[float]) -> float:
    return sorted(values)[math.ceil(len(values) * 0.99) - 1]


def megabytes(what: str) -> float:
    done = subprocess.run(
        [sys.executable, "-c", MEMORY, what], cwd=PROJECT, capture_output=True, text=True, timeout=120, check=True
    )
    return int(done.stdout.split()[-1]) / 1024
