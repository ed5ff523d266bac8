"""How long an excavator's planner needs from a goal to a checked trajectory, how long a cycle takes, what it weighs.

Straight ways: 300 random places around the machine, between two trucks; digs: the same places. Ways around: 800
random scenes, in which boxes stand and hang around the machine. A cycle of digging and loading: its two trajectories,
and the lag of the machine at the end of each. The floor of the time is the kinematics or the trajectory alone, of the
cycle its two swings; that of the memory a process that has only imported rclpy.

And how long the controller of tracks needs for a way around five machines on 100 m x 100 m. The floor is the fastest
path, and the look that it is not free.
"""

from __future__ import annotations

import contextlib
import math
import random
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import TypeVar

from bench.runner import PROJECT, Figure
from random_grounds import random_ground
from random_grounds import random_pose as random_track_pose
from random_scenes import random_pose, random_scene
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.detour import Question
from tms_control.ground import Outline
from tms_control.links import placed
from tms_control.planner import Goal, Pace
from tms_control.planner import Plan as TracksPlan
from tms_reason.errors import SubtaskFailed
from tms_rp.clearance import Clearance
from tms_rp.kind import Angles, Moves
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.digging import excavate, release
from tms_rp.kinds.backhoe.goals import ChangePose, Dig, Emptying, TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.neighbour import Neighbour, Posture
from tms_rp.reasons import Around, PartOf, Searched
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import trajectory
from tms_rp.ways import Ways

GOALS = 300
AROUND = 800  # scenes
IN_MEMORY = 150, 50  # digs and scenes for the memory
TRAJECTORY = 1.0  # ms for a straight trajectory on a usual PC
SITES = 200  # with five machines
FASTEST = 2.0  # ms for the fastest path of tracks on a usual PC
NOW = ArmAngles(0.0, -0.8029, 1.9897, 0.8029)
MEMORY = """
import re, pathlib, sys
sys.path[:0] = ["services", "tests"]
import rclpy
if sys.argv[1] == "all":
    import tms_rp.kinds.backhoe
    import tms_rp.node
    from bench.planning import IN_MEMORY, dig, plan_all, plan_around
    digs, scenes = IN_MEMORY
    plan_all(dig, digs), plan_around(scenes)
print(re.search(r"VmHWM:\\s+(\\d+)", pathlib.Path("/proc/self/status").read_text())[1])
"""


def measure() -> Iterable[Figure]:
    times, floors = plan_all(reach)
    assert len(times) > GOALS / 10, "hardly any of the places can be reached"
    yield Figure("goal p99", "ms", share(times, 0.99), 50.0, share(floors, 0.99), usual_floor=0.2)
    times, floors = plan_all(dig)
    assert len(times) > GOALS / 10, "hardly any of the places can be dug"
    yield Figure("dig p99", "ms", share(times, 0.99), 300.0, share(floors, 0.99), usual_floor=20.0)
    seconds, swings = cycle()
    yield Figure("dig and load", "s", seconds, 40.0, swings)
    manners, searches, floors = plan_around()
    assert len(manners) > 30 and len(searches) > 30, "the scenes ask for other ways"
    usual = share(floors, 0.5)
    yield Figure("manners p99", "ms", share(manners, 0.99), 100.0, usual, usual_floor=TRAJECTORY)
    yield Figure("search p50", "ms", share(searches, 0.5), 500.0, usual, usual_floor=TRAJECTORY)
    yield Figure("search p99", "ms", share(searches, 0.99), 3000.0, usual, usual_floor=TRAJECTORY)
    detours, floors = plan_tracks()
    assert len(detours) > 30, "the sites ask for other ways"
    usual = share(floors, 0.5)
    yield Figure("tracks p50", "ms", share(detours, 0.5), 200.0, usual, usual_floor=FASTEST)
    yield Figure("tracks p99", "ms", share(detours, 0.99), 1000.0, usual, usual_floor=FASTEST)
    yield Figure("memory", "MB", megabytes("all"), 150.0, megabytes("rclpy"))


def model_of(name: str) -> MachineModel:
    return parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel)


Made = TypeVar("Made")
Asked = Callable[[Backhoe, TipGoal], Moves]


def reach(backhoe: Backhoe, place: TipGoal) -> Moves:
    return backhoe.change_pose(NOW, ChangePose(tips=(place,)))


def dig(backhoe: Backhoe, place: TipGoal) -> Moves:
    return excavate(backhoe, NOW, Dig(place, depth=0.5, drag=1.5, lift=0.5))


def plan_all(goal: Asked, count: int = GOALS) -> tuple[list[float], list[float]]:
    """Milliseconds of each goal that needs no way around, and of its kinematics."""
    model, truck = model_of("zx200"), model_of("ic120")
    backhoe, ways, rng = Backhoe(model), Ways(model, load("backhoe")), random.Random(1)
    scene = Scene(
        tuple(
            Obstacle(PartOf(part, f"ic120_{i}"), box, placed(x, y, math.pi / 2))
            for i, (x, y) in enumerate(((8.0, 3.0), (-7.0, -2.0)))
            for part, box in truck.footprint.items()
        )
    )
    times, floors = [], []
    for _ in range(count):
        away, turn = rng.uniform(4, 8), rng.uniform(-math.pi, math.pi)
        place = TipGoal(away * math.cos(turn), away * math.sin(turn), rng.uniform(-1, 2), rng.uniform(0, 2))
        with contextlib.suppress(SubtaskFailed):  # out of reach, or in a truck
            moves, kinematics = timed(partial(goal, backhoe, place))
            plan, taken = timed(partial(ways.plan, NOW, moves, scene))
            if not any(isinstance(note, Around) for note in plan.notes):
                floors.append(kinematics)
                times.append(kinematics + taken)
    return times, floors


def cycle() -> tuple[float, float]:
    """Seconds from over a truck, empty, to a dig at a right angle to it and back; and of the two swings alone."""
    model, truck = model_of("zx200"), model_of("ic120")
    backhoe, ways = Backhoe(model), Ways(model, load("backhoe"))
    posture = Posture(dict.fromkeys(truck.joints, 0.0), 0.0)
    scene = Scene(tuple(Neighbour("ic120", truck).obstacles(placed(1.44, 6.0, 0.0), 0.0, posture)))
    over = Emptying(-0.34, TipGoal(0.0, 6.0, 4.2, 3.0))
    face = Dig(TipGoal(6.5, 0.0, 0.0, 1.6), depth=0.5, drag=1.5, lift=0.5)
    now, seconds, swings = NOW, 0.0, 0.0
    for number in range(4):  # the first two bring it to where a cycle begins
        load_it = number % 2
        goal = release(backhoe, now, over) if load_it else excavate(backhoe, now, face)
        made = ways.plan(now, goal, scene).made
        end = ArmAngles(*made.samples[-1].positions[:4])
        if number > 1:
            seconds += made.duration + ways.late
            swings += trajectory(model.joints, (*now, 0.0), [(end.swing, *now[1:], 0.0)]).duration
        now = end
    return seconds, swings


def plan_around(count: int = AROUND) -> tuple[list[float], list[float], list[float]]:
    """Milliseconds of each goal with a way by manners, with a searched one, and of a straight trajectory."""
    model = model_of("zx200")
    ways, clearance, rng = Ways(model, load("backhoe")), Clearance(model), random.Random(1)
    manners, searches, floors = [], [], []
    for _ in range(count):
        scene = random_scene(rng)
        now, target = (free_pose(rng, clearance, scene) for _ in range(2))
        floors.append(clock(partial(trajectory, model.joints, (*now, 0.0), [(*target, 0.0)])))
        work = partial(ways.plan, now, Moves((target,)), scene)
        with contextlib.suppress(SubtaskFailed):  # no way, or the target is too near to something
            plan, taken = timed(work)
            if plan.notes:
                taken = min(taken, clock(work))  # what the same work takes longer, other programs take
            for note in plan.notes:
                (searches if note == Around(Searched(), note.why) else manners).append(taken)
    return manners, searches, floors


def plan_tracks() -> tuple[list[float], list[float]]:
    """Milliseconds of each way around five machines, and of the fastest path, which is not free."""
    rng, pace = random.Random(1), Pace(forward=1.0, turn=0.24)
    outline = Outline.of(model_of("ic120"))
    detours, floors = [], []
    for _ in range(SITES):
        ground, start, goal = random_ground(rng, 5), random_track_pose(rng), random_track_pose(rng)
        question = Question(start, (Goal(*goal),), pace, 0.0, outline, ground)
        free, fastest = timed(question.fastest)
        if free is None:
            answer, taken = timed(question.answer)
            if isinstance(answer, TracksPlan):
                floors.append(min(fastest, clock(question.fastest)))
                detours.append(min(taken, clock(question.answer)))
    return detours, floors


def free_pose(rng: random.Random, clearance: Clearance, scene: Scene) -> Angles:
    with clearance.looking(scene.with_ground()) as view:
        while not view.free((*(pose := random_pose(rng)), 0.0)):
            pass
    return pose


def timed(work: Callable[[], Made]) -> tuple[Made, float]:
    """What a work makes, and in how many milliseconds."""
    begun = time.perf_counter()
    made = work()
    return made, (time.perf_counter() - begun) * 1000


def clock(work: Callable[[], object]) -> float:
    return timed(work)[1]


def share(values: list[float], part: float) -> float:
    """What this part of the values does not exceed."""
    return sorted(values)[math.ceil(len(values) * part) - 1]


def megabytes(what: str) -> float:
    done = subprocess.run(
        [sys.executable, "-c", MEMORY, what], cwd=PROJECT, capture_output=True, text=True, timeout=120, check=True
    )
    return int(done.stdout.split()[-1]) / 1024
