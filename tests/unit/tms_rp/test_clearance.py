"""A motion through a truck or through the machine itself is refused with both names; others pass."""

import itertools
import math
from collections.abc import Iterator
from contextlib import suppress

import fcl
import numpy as np
import pytest

from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_control.links import Links, placed
from tms_reason.errors import SubtaskFailed
from tms_rp.clearance import PADDING, Clearance
from tms_rp.meshes import Mesh, cone
from tms_rp.reasons import Collision, Part, PartOf, Told
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory, trajectory

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
RIGHT = (-1.571, -0.9, 2.0, 1.7, 0.0)
FRONT = (0.0, -0.9, 2.0, 1.7, 0.0)
LOW_RIGHT = (-1.571, -0.3, 1.4, 0.5, 0.0)
LOW_FRONT = (0.0, -0.3, 1.4, 0.5, 0.0)


def truck(x: float, y: float) -> Scene:
    """An ic120 across the front, the middle of its vessel at (x, y)."""
    place = placed(x, y + 1.44, math.pi / 2)
    return Scene(tuple(Obstacle(PartOf(part, "ic120"), box, place) for part, box in TRUCK.footprint.items()))


def move(*poses: tuple[float, ...]) -> Trajectory:
    return trajectory(MODEL.joints, poses[0], poses[1:])


def refusal(made: Trajectory, scene: Scene) -> Collision:
    with pytest.raises(SubtaskFailed) as caught:
        Clearance(MODEL).check(made, scene)
    assert isinstance(caught.value.reason, Collision)
    return caught.value.reason


def test_without_anything_in_the_way_it_passes() -> None:
    Clearance(MODEL).check(move(RIGHT, FRONT), Scene())
    Clearance(MODEL).check(move(RIGHT, FRONT), truck(20.0, 0.0))


def test_a_truck_in_the_way_is_named() -> None:
    said = refusal(move(LOW_RIGHT, LOW_FRONT), truck(6.0, 0.0))
    assert isinstance(said.first, Part) and said.first.link.endswith("_link") and said.seconds > 0
    assert isinstance(said.second, PartOf) and said.second.machine == "ic120"


def test_a_truck_that_is_only_swept_is_found_too() -> None:
    """The end is free; without looking on the way it would pass."""
    beyond = (1.571, *LOW_FRONT[1:])
    Clearance(MODEL).check(move(beyond, beyond), truck(6.0, 0.0))
    found = refusal(move(LOW_RIGHT, beyond), truck(6.0, 0.0)).find(PartOf)
    assert found is not None and found.machine == "ic120"


def test_over_the_vessel_it_passes() -> None:
    high = (-1.571, -1.1, 1.9, 1.9, 0.0)
    Clearance(MODEL).check(move(high, (0.0, *high[1:])), truck(4.55, -0.17))


def test_the_bucket_against_the_own_tracks() -> None:
    said = refusal(move((0.0, -0.3, 2.2, 0.5, 0.0), (0.0, -0.12, 2.687, 0.5, 0.0)), Scene())
    assert Part("track_link") in (said.first, said.second)


def test_what_touches_at_the_start_may_part_but_not_stay() -> None:
    inside = LOW_FRONT
    away = (-1.571, *LOW_FRONT[1:])
    Clearance(MODEL).check(move(inside, away), truck(6.0, 0.0))
    refusal(move(inside, (0.1, *LOW_FRONT[1:])), truck(6.0, 0.0))


@pytest.mark.parametrize("gap", [0.005, 0.05, 0.09])
def test_what_only_the_padding_touches_at_the_start_is_not_gone_through(gap: float) -> None:
    """A thin wall beside the bucket: on its other side nothing touches any more."""
    lowest = min(corners("bucket_link", LOW_FRONT), key=lambda corner: corner[2])
    edge = max(corner[1] for corner in corners("bucket_link", LOW_FRONT))
    wall = Box(min=(lowest[0] - 0.3, edge + gap, lowest[2]), max=(lowest[0] + 0.3, edge + gap + 0.1, lowest[2] + 0.3))
    scene = Scene((Obstacle(PartOf("wall", "site"), wall, np.eye(4)),))
    said = refusal(move(LOW_FRONT, (1.571, *LOW_FRONT[1:])), scene)
    assert said.second == PartOf("wall", "site")
    Clearance(MODEL).check(move(LOW_FRONT, LOW_RIGHT), scene)


def corners(link: str, pose: tuple[float, ...]) -> Iterator[tuple[float, ...]]:
    shape, place = MODEL.shapes[link], Links(MODEL).places(np.array([pose]))[link][0]
    for corner in itertools.product(*zip(shape.min, shape.max, strict=True)):
        yield tuple(map(float, place[:3, :3] @ corner + place[:3, 3]))


def test_looking_again_makes_no_new_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of them leaks: 80 KB a task."""
    clearance, made = Clearance(MODEL), move(RIGHT, FRONT)
    for x in (40.0, 8.0):
        with suppress(SubtaskFailed):
            clearance.check(move(LOW_RIGHT, LOW_FRONT), truck(x, 0.0))
    monkeypatch.setattr("tms_rp.bodies.fcl.CollisionObject", None)
    clearance.check(made, truck(50.0, 0.0))
    with pytest.raises(SubtaskFailed, match="of ic120 after"):
        clearance.check(move(LOW_RIGHT, LOW_FRONT), truck(8.0, 0.0))


def heap(x: float, height: float = 1.0, off: float = 0.0) -> Scene:
    """A cone of soil before the machine, as a surface."""
    made = cone(height, 1.5)
    mesh, place = Mesh(made.vertices, made.faces, off), placed(x, 0.0, 0.3)
    place[2, 3] = height / 2
    return Scene((Obstacle(Told("heap"), mesh.box, place, mesh=mesh),))


def test_a_surface_in_the_way_is_named_with_the_place() -> None:
    bucket = max(corners("bucket_link", LOW_FRONT))
    scene = heap(bucket[0] - 1.0, 3.0)
    said = refusal(move(LOW_RIGHT, LOW_FRONT), scene)
    assert said.second == Told("heap") and 0 < said.depth < 3.0
    assert math.hypot(said.x - bucket[0] + 1.0, said.y) < 3.0 and -0.01 < said.z < 3.2
    Clearance(MODEL).check(move(RIGHT, FRONT), heap(bucket[0] - 1.0, 0.5))


def test_how_far_a_surface_may_be_off_is_kept_away_from() -> None:
    lowest = min(corners("bucket_link", FRONT), key=lambda corner: corner[2])
    height = lowest[2] - PADDING - 0.1  # its top is 10 cm below the padding
    assert height > 0.2
    Clearance(MODEL).check(move(RIGHT, FRONT), heap(lowest[0], height))
    said = refusal(move(RIGHT, FRONT), heap(lowest[0], height, off=0.4))
    assert said.second == Told("heap") and said.depth > 0
    grown = tuple(one.grown(0.4) for one in heap(lowest[0], height).obstacles)
    assert refusal(move(RIGHT, FRONT), Scene(grown)).second == Told("heap")


def test_more_padding_of_a_link_is_kept() -> None:
    lowest = min(corners("bucket_link", FRONT), key=lambda corner: corner[2])
    plate = Box(min=(lowest[0] - 1, -1.0, -0.2), max=(lowest[0] + 1, 1.0, lowest[2] - PADDING - 0.2))
    below = Obstacle(Told("plate"), plate, np.eye(4))
    made, clearance = move(RIGHT, FRONT), Clearance(MODEL)
    clearance.check(made, Scene((below,)))
    clearance.check(made, Scene((below,), padding=(("bucket_link", 0.05), ("boom_link", 0.5), ("track_link", 2.0))))
    with pytest.raises(SubtaskFailed, match="bucket_link would touch plate"):
        clearance.check(made, Scene((below,), padding=(("bucket_link", 0.5),)))
    Clearance(MODEL, padding=0.0).check(made, Scene((below,), padding=(("bucket_link", 0.5),)))


def test_a_surface_is_made_once_and_an_old_one_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    alive, made = set[int](), list[int]()

    class Counted(fcl.BVHModel):  # type: ignore[misc]
        def __init__(self) -> None:
            alive.add(id(self))
            made.append(id(self))

        def __del__(self) -> None:
            alive.discard(id(self))

    monkeypatch.setattr("tms_rp.bodies.fcl.BVHModel", Counted)
    clearance, motion = Clearance(MODEL), move(LOW_RIGHT, LOW_FRONT)
    for height in (2.8, 2.9, 3.0, 3.0, 3.0):
        for scene in (heap(7.0, height), Scene(tuple(one.grown(0.3) for one in heap(7.0, height).obstacles))):
            with suppress(SubtaskFailed):
                clearance.check(motion, scene)
    assert (len(made), len(alive)) == (3, 1)
