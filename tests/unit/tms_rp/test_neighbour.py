"""A raised vessel and a stretched arm are where they were told; what was told long ago may be somewhere else."""

import math

import numpy as np
import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.links import placed
from tms_machine.drift import FRESH
from tms_rp.neighbour import Neighbour, Posture
from tms_rp.reasons import PartOf
from tms_rp.scene import GROWTH_STEP, Obstacle


def model(name: str) -> MachineModel:
    return parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel)


TRUCK, DIGGER = Neighbour("ic120_1", model("ic120")), Neighbour("zx120_1", model("zx120"))
STRETCHED = {"swing_joint": math.pi / 2, "boom_joint": -0.3, "arm_joint": 0.6, "bucket_joint": 0.0}


def part(found: list[Obstacle], link: str) -> Obstacle:
    return next(one for one in found if isinstance(one.name, PartOf) and one.name.link == link)


def corners(one: Obstacle) -> np.ndarray:
    low, high = np.array(one.box.min), np.array(one.box.max)
    unit = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    turn = np.array([[math.cos(one.box.pitch), 0, math.sin(one.box.pitch)], [0, 1, 0],
                     [-math.sin(one.box.pitch), 0, math.cos(one.box.pitch)]])  # fmt: skip
    return (low + unit * (high - low)) @ turn.T @ one.place[:3, :3].T + one.place[:3, 3]


def test_a_raised_vessel_is_higher_than_the_cab() -> None:
    lowered, raised = (
        part(TRUCK.obstacles(placed(8.0, 0.0, 0.0), 0.0, Posture({"vessel_pin_joint": angle}, 0.0)), "vessel_link")
        for angle in (0.0, -1.1)
    )
    assert corners(lowered)[:, 2].max() == pytest.approx(2.872, abs=1e-3)
    assert corners(raised)[:, 2].max() > 4.5


def test_the_arm_of_another_excavator_is_where_it_points() -> None:
    place = placed(0.0, -12.0, 0.0)
    assert not any("arm_link" in str(one.name) for one in DIGGER.obstacles(place, 0.0))
    bucket = part(DIGGER.obstacles(place, 0.0, Posture(STRETCHED, 0.0)), "bucket_link")
    assert corners(bucket)[:, 1].max() > -12.0 + 7.0  # it points to our left, at us


def test_fresh_news_grow_nothing() -> None:
    for age in (0.0, FRESH, -math.inf):  # the last: a fixed frame
        assert part(TRUCK.obstacles(np.eye(4), age), "cab").box == model("ic120").footprint["cab"]


def test_an_old_place_is_grown_by_what_it_may_have_driven_until_it_had_lost_its_permit() -> None:
    def width(age: float) -> float:
        box = part(TRUCK.obstacles(np.eye(4), age), "cab").box
        return box.max[0] - model("ic120").footprint["cab"].max[0]

    assert width(FRESH + 0.5) == pytest.approx(0.5 * (1.0 + 0.349 * math.hypot(3.6, 1.317)), abs=GROWTH_STEP)
    assert width(60.0) == width(3600.0) < 7.0


def test_old_joints_grow_the_links_that_they_move_and_nothing_else() -> None:
    found = DIGGER.obstacles(np.eye(4), 0.0, Posture(STRETCHED, FRESH + 0.5))
    fresh = DIGGER.obstacles(np.eye(4), 0.0, Posture(STRETCHED, 0.0))

    def growth(link: str) -> float:
        return part(found, link).box.max[2] - part(fresh, link).box.max[2]

    assert growth("tracks") == 0.0 < growth("boom_link") < growth("arm_link") < growth("bucket_link")


def test_an_arm_that_is_not_heard_may_be_anywhere_but_no_further_than_it_reaches() -> None:
    bucket = part(DIGGER.obstacles(np.eye(4), 0.0, Posture(STRETCHED, 3600.0)), "bucket_link")
    assert 8.0 < np.abs(corners(bucket)[:, 0]).max() < 13.0
