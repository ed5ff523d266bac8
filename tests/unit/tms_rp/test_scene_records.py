"""Scene records become obstacles; one that nobody can understand, or that is too old, refuses the goal."""

import math

import numpy as np
import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.reasons import PartOf, SceneRecordOld, Told
from tms_rp.scene import Obstacle
from tms_rp.scene_records import SceneRecord

TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
LEFT = {"qz": math.sin(math.pi / 4), "qw": math.cos(math.pi / 4)}  # a quarter turn about z


def record(name: str = "collision_object_wall", age: float = 0.0, max_age: float = 0.0, dynamic: bool = True,
           **values: Value) -> list[Obstacle]:  # fmt: skip
    return SceneRecord(name, {"x": 6.0, "y": 1.0, "z": 0.5, **values}, age, max_age, dynamic).obstacles(
        {"ic120": TRUCK, "ic120_1": TRUCK}
    )


def refusal(age: float = 0.0, max_age: float = 0.0, name: str = "collision_object_wall", **values: Value) -> Reason:
    with pytest.raises(SubtaskFailed) as caught:
        record(name, age, max_age, **values)
    return caught.value.reason


def test_a_box_stands_where_and_how_it_is_told() -> None:
    (wall,) = record(dimensions=[2.0, 4.0, 6.0], **LEFT)
    assert wall.name == Told("collision_object_wall")
    assert wall.box.max == pytest.approx((1.0, 2.0, 3.0)) and wall.box.min == pytest.approx((-1.0, -2.0, -3.0))
    assert wall.place @ [1.0, 0.0, 0.0, 1.0] == pytest.approx([6.0, 2.0, 0.5, 1.0])  # its x axis is our y axis


def test_any_turn_is_taken_over() -> None:
    half = math.sqrt(0.5)
    (rolled,) = record(dimensions=[2.0, 4.0, 6.0], qx=half, qw=half)
    assert rolled.place[:3, :3] @ [0.0, 1.0, 0.0] == pytest.approx([0.0, 0.0, 1.0])
    assert np.linalg.det(rolled.place[:3, :3]) == pytest.approx(1.0)


def test_sizes_are_rounded_up() -> None:
    (wall,) = record(dimensions=[0.301, 0.3, 0.3])
    assert wall.box.max == pytest.approx((0.2, 0.15, 0.15))


@pytest.mark.parametrize("named", ["ic120", "ic120_1"])
def test_without_dimensions_it_is_the_machine_that_it_is_named_after(named: str) -> None:
    parts = record(f"collision_object_{named}")
    assert [one.name for one in parts] == [PartOf("vessel", named), PartOf("cab", named)]
    assert {one.place[0, 3] for one in parts} == {6.0}


def test_a_machine_that_sensing_has_told_long_ago_is_grown_and_one_of_a_person_is_not() -> None:
    sensed, typed = (record("collision_object_ic120", age=30.0, dynamic=dynamic)[1] for dynamic in (True, False))
    assert sensed.box.max[0] > typed.box.max[0] == TRUCK.footprint["cab"].max[0]


def test_a_record_that_is_too_old_refuses() -> None:
    assert record(age=2.0, max_age=3.0, dimensions=[1.0, 1.0, 1.0])
    assert refusal(age=4.0, max_age=3.0, dimensions=[1.0, 1.0, 1.0]) == SceneRecordOld("collision_object_wall", 4.0)


@pytest.mark.parametrize(
    "values",
    [
        {"x": math.nan, "dimensions": [1.0, 1.0, 1.0]},
        {"dimensions": [1.0, math.inf, 1.0]},
        {"dimensions": [1.0, 0.0, 1.0]},
        {"dimensions": [1.0, 1.0]},
        {"dimensions": [1.0, 1.0, 1.0], "primitive_type": 3},
        {"dimensions": [1.0, 1.0], "primitive_type": 2},
        {"dimensions": [1.0, 1.0], "primitive_type": 5},
        {"dimensions": [1.0, 1.0, 1.0], "qw": 0.3},
        {},
    ],
)
def test_a_record_that_makes_no_sense_refuses(values: dict[str, Value]) -> None:
    assert isinstance(refusal(**values), BadRecord)  # type: ignore[arg-type]


def test_the_place_may_be_nested_as_in_version_6() -> None:
    nested = {"position": {"x": 1.0, "y": 2.0, "z": 3.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
    (wall,) = SceneRecord(
        "post", {"pose": nested, "primitive_type": 1, "dimensions": [1.0, 1.0, 1.0]}, 0, 0, True
    ).obstacles({})
    assert wall.place[:3, 3] == pytest.approx([1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("kind", "sizes", "sides"), [(2, [1.0], (2, 2, 2)), (3, [3.0, 1.0], (2, 2, 3)), (4, [3.0, 1.0], (2, 2, 3))]
)
def test_round_bodies(kind: int, sizes: list[float], sides: tuple[float, ...]) -> None:
    (body,) = record(primitive_type=kind, dimensions=sizes)
    assert body.mesh is not None
    assert np.subtract(body.box.max, body.box.min) == pytest.approx(sides, rel=0.03)
