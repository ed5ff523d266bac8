"""Digs and ways on the ground as it is: over a bank of soil, in a pit's bottom, on a platform."""

import math

import numpy as np
import pytest

from tms_config.models import MachineModel
from tms_reason.errors import SubtaskFailed
from tms_rp.kind import Moves
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.digging import excavate
from tms_rp.kinds.backhoe.goals import Dig, TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.scene import Scene
from tms_rp.scene_view import way_of_tip
from tms_rp.terrain import Terrain
from tms_rp.trajectory import Trajectory
from tms_rp.ways import Ways
from tms_soil.surface import Heights

START = ArmAngles(0.0, -0.8029, 1.9897, 0.8029)
BANK = 2.6  # m


def scene(model: MachineModel, z: np.ndarray) -> Scene:
    return Scene(ground=Terrain(Heights(-26.0, -26.0, 0.2, z), model.tracks, (0.0, 0.0, 0.0)))


def level(z: float = 0.0) -> np.ndarray:
    return np.full((260, 260), z)


def with_bank() -> np.ndarray:
    """A bank to the right ahead, between where the arm is and where it digs."""
    told = Heights(-26.0, -26.0, 0.2, level())
    x, y = told.centres
    bearing, away = np.arctan2(y, x), np.hypot(x, y)
    told.z[(np.abs(bearing + 0.8) < 0.15) & (away > 4.0) & (away < 9.0)] = BANK
    return told.z


def dig(backhoe: Backhoe, bearing: float = -math.pi / 2, z: float = 0.0) -> Moves:
    at = TipGoal(5.5 * math.cos(bearing), 5.5 * math.sin(bearing), z, 1.4)
    return excavate(backhoe, START, Dig(at, depth=0.5, drag=0.8, lift=0.5))


def over_the_bank(model: MachineModel, made: Trajectory) -> float:
    """The least height [m] of the bucket's tip over the bank."""
    points = np.array([(one[0], one[1], one[2]) for one in way_of_tip(model, made)])
    bearing = np.arctan2(points[:, 1], points[:, 0])
    return float(points[np.abs(bearing + 0.8) < 0.15, 2].min())


def test_on_a_platform_it_digs_as_on_level_ground(model: MachineModel, backhoe: Backhoe) -> None:
    ways = Ways(model, load("backhoe"))
    flat = ways.plan(START, dig(backhoe), Scene())
    told = ways.plan(START, dig(backhoe), scene(model, level(4.0)))
    assert told.made.duration == pytest.approx(flat.made.duration, abs=1e-6)


def test_it_swings_over_a_bank(model: MachineModel, backhoe: Backhoe) -> None:
    ways = Ways(model, load("backhoe"))
    flat = ways.plan(START, dig(backhoe), Scene())
    assert over_the_bank(model, flat.made) < BANK, "on level ground it goes lower"
    told = ways.plan(START, dig(backhoe), scene(model, with_bank()))
    assert over_the_bank(model, told.made) > BANK


def test_the_boom_does_not_go_through_the_edge_of_a_pit(model: MachineModel, backhoe: Backhoe) -> None:
    told = Heights(-26.0, -26.0, 0.2, level())
    _, y = told.centres
    wall = (y < -3.2) & (y > -4.6)  # between the machine and what it digs, higher than its arm gets over
    told.z[wall] = 3.6
    ways = Ways(model, load("backhoe"))
    ways.plan(START, dig(backhoe), Scene())
    with pytest.raises(SubtaskFailed):
        ways.plan(START, dig(backhoe), scene(model, told.z))


def test_only_the_bucket_is_in_the_ground_where_it_lies_higher(model: MachineModel, backhoe: Backhoe) -> None:
    told = Heights(-26.0, -26.0, 0.2, level())
    x, y = told.centres
    told.z[(np.abs(x) < 3.0) & (y < -4.0)] = 0.6  # a bench, on which it digs
    ways = Ways(model, load("backhoe"))
    plan = ways.plan(START, dig(backhoe, z=0.6), scene(model, told.z))
    assert plan.made.duration > 3.0
