"""How exactly our controllers bring joints and tracks of OperaSim-PhysX to where they should be.

In virtual time, against the stand-in of the simulator. Notes of joints tell how far off a plain controller is, one that
sends the reference of the moment and knows nothing of the drives. What a controller costs is measured on processes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from bench.rig.controlled import costs
from bench.runner import Figure
from driven_joints import DrivenJoints
from driven_tracks import GAINS, DrivenTracks
from tms_control.path import Pose
from tms_control.trip_task import Task

MOVES = [
    ("zx200", "swing_joint", 1.2), ("zx200", "boom_joint", 0.5), ("zx200", "arm_joint", -0.6),
    ("zx200", "bucket_joint", 0.8), ("zx120", "boom_joint", 0.4), ("zx120", "swing_joint", 0.9),
    ("ic120", "vessel_pin_joint", -0.5), ("mst110cr", "rotate_joint", 0.8), ("mst110cr", "dump_joint", -0.5),
]  # fmt: skip
WORST, SETTLED = 0.05, 0.5  # rad, s
OFF = {"lag": 1.3, "dead_time": 0.05}  # how the drives differ from the machine file
AWAY, ASKEW = 0.3, 0.1  # m, rad at waypoints
WAYPOINTS = [Pose(6.0, 2.0, 0.5), Pose(9.0, 8.0, 2.0), Pose(3.0, 6.0, -2.5)]
TRACKS = ("zx200", "ic120", "mst110cr", "zx120")
IDLE, MOVING = 3.0, 15.0  # % of a core


def measure() -> Iterable[Figure]:
    yield from _joints("known drives", {}, 0)
    yield from _joints("after two moves", OFF, 2)
    yield from _tracks()
    idle, moving, floor = costs()
    yield Figure("controller, idle", "%", idle, IDLE, floor)
    yield Figure("controller, moving", "%", moving, MOVING, floor)


def _joints(name: str, off: dict[str, float], learns: int) -> Iterable[Figure]:
    """The worst of all moves, after `learns` moves of the same joint."""
    worst, settled, floors = (0.0, ""), (0.0, ""), list[float]()
    for model, joint, way in MOVES:
        ours = DrivenJoints(model, **off)
        for turn in range(learns):
            ours.until(ours.begin(joint, way * (-1) ** turn))
        seen = ours.until(ours.begin(joint, way * (-1) ** learns), joint)
        worst = max(worst, (seen.worst, f"{model} {joint}"))
        settled = max(settled, (seen.settled, f"{model} {joint}"))
        plain = DrivenJoints(model, streams=True, **off)
        floors.append(plain.until(plain.begin(joint, way), joint).worst)
    yield Figure(f"joints, {name}", "rad", worst[0], WORST, note=f"{worst[1]}; plain {max(floors):.2f} rad")
    yield Figure(f"settled, {name}", "s", settled[0], SETTLED, note=settled[1])


def _tracks() -> Iterable[Figure]:
    for gain in GAINS:
        away, turned = (0.0, ""), (0.0, "")
        for model in TRACKS:
            for goal in WAYPOINTS:
                driven = DrivenTracks(model, gain)
                trip = driven.trip(Task.to(goal))
                driven.run(trip)
                there = driven.pose
                away = max(away, (there.away(goal), model))
                turned = max(turned, (abs(math.remainder(there.yaw - goal.yaw, math.tau)), model))
        yield Figure(f"waypoints, yaw gain {gain:.2f}", "m", away[0], AWAY, note=away[1])
        yield Figure(f"headings, yaw gain {gain:.2f}", "rad", turned[0], ASKEW, note=turned[1])
