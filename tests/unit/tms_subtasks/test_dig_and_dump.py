"""Subtasks of earth choose by the ground, the loads and the records of this moment, and write records."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tms_msg_ground.msg import SoilLoad

from earth_rig import flat, model_of
from tms_config.models import MachineModel
from tms_control.links import Links, Matrix, placed
from tms_kit.subtask import Subtask, SubtaskCancelled
from tms_machine.frames import FramePose
from tms_machine.reasons import Aborted, NoReason, WaitingFor
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_soil.surface import Bounds, Heights, Point
from tms_subtasks.choose_dig_point import ChooseDigPoint
from tms_subtasks.choose_dump_point import ChooseDumpPoint
from tms_subtasks.dig_again_until import DigAgainUntil
from tms_subtasks.wait_until_loaded import Loading, WaitUntilLoaded

MODELS = {"zx200": model_of("zx200"), "ic120": model_of("ic120"), "other": model_of("ic120")}
AREA = {"area_x": [-4.0, 2.0, 2.0, -4.0], "area_y": [-9.0, -9.0, -3.5, -3.5], "floor": -1.5, "near": 4.8, "far": 8.0,
        "deepest": 1.8, "trucks": ["other", "ic120"], "job": "EARTHWORK"}  # fmt: skip
AT_FACE = (4.55, 1.27, 1.5708)  # of a truck whose vessel is in front of the excavator


class Yard:
    """A zx200 at the origin of map on level ground, two trucks far away."""

    def __init__(self) -> None:
        self.places = {"zx200": (0.0, 0.0, 0.0), "ic120": (50.0, 0.0, 0.0), "other": (60.0, 0.0, 0.0)}
        self.carried = {"zx200": 0.0, "ic120": 0.0, "other": 0.0}  # m3, loose
        self.time_passes: Callable[[], None] = lambda: None
        self.level = 0.0

    def model(self, machine: str) -> MachineModel:
        return MODELS[machine]

    def place(self, machine: str, check: Any) -> FramePose:
        return FramePose(*self.places[machine], 0.0)

    def link(self, machine: str, link: str, check: Any) -> Matrix:
        pose = np.zeros((1, len(MODELS[machine].joints)))
        return placed(*self.places[machine]) @ Links(MODELS[machine], [link]).places(pose)[link][0]

    def taken(self, own: str) -> list[Sequence[Point]]:
        return []

    def loads(self, machines: Sequence[str], check: Any) -> list[SoilLoad]:
        self.time_passes()
        volumes = {name: self.carried[name] for name in machines}
        return [
            SoilLoad(loose=loose, bank=loose / 1.25, capacity=0.83 if name == "zx200" else 5.9)
            for name, loose in volumes.items()
        ]

    def ground(self, bounds: Bounds, floor: float, check: Any) -> tuple[Heights, Heights]:
        level = flat(25.6, self.level)
        return level, replace(level, z=np.full(level.z.shape, floor))


class Machine:
    """Its planner refuses the first `refuses` digs."""

    def __init__(self, name: str, yard: Yard, refuses: int = 0, why: Reason | None = None) -> None:
        self.name, self.model, self.yard, self.checks = name, MODELS[name], yard, 0
        self.asked: list[tuple[Any, ...]] = []
        self.gives_up = False
        self._refuses, self._why = refuses, why or Aborted(NoReason(), "excavate_plan")

    def check(self) -> None:
        self.checks += 1
        if self.gives_up:
            raise SubtaskCancelled

    def excavate(self, progress: Any, tip: Any, theta_w: float, offset: float, plan_only: bool, **shape: float) -> None:
        assert plan_only, "choosing moves nothing"
        self.asked.append((tip, shape))
        if len(self.asked) <= self._refuses:
            raise SubtaskFailed(self._why)


class Records:
    def __init__(self) -> None:
        self.of: dict[tuple[str, str], dict[str, Any]] = {
            ("zx200", "earthwork"): dict(AREA),
            ("zx200", "dig_point"): {"number": 3},
            ("zx200", "dump_point"): {"x": 3.5, "y": 0.0, "number": 2, "truck": "ic120", "bank": 0.5, "before": 0.4},
            ("", "EARTHWORK"): {"volume": 1.2, "moved": 0.4, "counted": 1, "done": False},
        }

    def read(self, machine: str, record: str, _max_age: float = 0.0) -> dict[str, Any]:
        return dict(self.of[machine, record])

    def write(self, machine: str, record: str, values: Mapping[str, Any], _create: bool) -> None:
        self.of[machine, record].update(values)


@pytest.fixture
def yard() -> Yard:
    return Yard()


@pytest.fixture
def records() -> Records:
    return Records()


def execute(kind: type[Subtask], machine: Machine, records: Records, want: Any = None) -> list[Reason | str]:
    said: list[Reason | str] = []
    one: Any = kind(machine, want, records.read, records.write)  # type: ignore[arg-type]
    one.execute(machine.name, "earthwork", said.append)
    return said


def test_it_digs_where_the_ground_is_now(yard: Yard, records: Records) -> None:
    machine = Machine("zx200", yard)
    execute(ChooseDigPoint, machine, records)
    found = records.of["zx200", "dig_point"]
    ((tip, shape),) = machine.asked
    assert (found["x"], found["y"], found["z"]) == tip and found["z"] == 0.0
    assert (found["depth"], found["drag"]) == (shape["depth"], shape["drag"])
    assert found["position_with_angle"] == 1.0 and found["number"] == 2, "the bucket after the last one that counts"
    yard.level = 0.4
    records.of["zx200", "earthwork"]["floor"] = 0.0
    execute(ChooseDigPoint, machine, records)
    assert records.of["zx200", "dig_point"]["depth"] == pytest.approx(0.4), "sensing has raised floor and ground"


def test_what_the_planner_refuses_is_not_chosen(yard: Yard, records: Records) -> None:
    machine = Machine("zx200", yard, refuses=15)
    execute(ChooseDigPoint, machine, records)
    assert len(machine.asked) == 16, "late in a job many are refused"
    assert records.of["zx200", "dig_point"]["x"] == machine.asked[-1][0][0]


def test_a_planner_that_refuses_all_or_is_away_fails_it(yard: Yard, records: Records) -> None:
    with pytest.raises(SubtaskFailed, match="NO_DIG_PLANNED"):
        execute(ChooseDigPoint, Machine("zx200", yard, refuses=99), records)
    away = Machine("zx200", yard, refuses=1, why=WaitingFor("zx200:rp"))
    with pytest.raises(SubtaskFailed, match="WAITING_FOR"):
        execute(ChooseDigPoint, away, records)
    assert records.of["zx200", "dig_point"] == {"number": 3}


def test_nothing_left_is_a_refusal(yard: Yard, records: Records) -> None:
    yard.level = -1.5
    with pytest.raises(SubtaskFailed, match=r"NOTHING_TO_DIG.*zx200"):
        execute(ChooseDigPoint, Machine("zx200", yard), records)


@pytest.mark.turns
def test_a_dig_that_brings_nothing_is_not_tried_for_ever(yard: Yard, records: Records) -> None:
    """The ground promises soil that the arm does not get: it digs elsewhere, and at last the job is done."""
    records.of["", "EARTHWORK"] |= {"volume": 9.0, "counted": 0}
    records.of["zx200", "dump_point"] |= {"number": 0, "bank": 0.0, "before": 0.0}
    records.of["zx200", "dig_point"]["number"] = 0
    job, dug = records.of["", "EARTHWORK"], list[tuple[float, float, float]]()
    while not job["done"] and len(dug) < 300:
        execute(ChooseDigPoint, Machine("zx200", yard), records)
        point = records.of["zx200", "dig_point"]
        dug.append((point["x"], point["y"], point["depth"]))
        brings = 0.5 if len(dug) == 4 else 0.0
        records.of["zx200", "dump_point"] |= {"number": point["number"], "bank": brings}
        execute(DigAgainUntil, Machine("zx200", yard), records)
    assert job["done"] and job["counted"] == len(dug) > 20
    assert len(set(dug[:4])) == 4 and dug[4] == dug[0], "after one that brings soil all are tried again"
    assert len(set(dug[4:])) == len(dug) - 4


def test_the_truck_that_stands_in_reach_and_has_room_is_loaded(yard: Yard, records: Records) -> None:
    yard.carried |= {"zx200": 0.75, "ic120": 1.0}
    yard.places["ic120"] = AT_FACE
    execute(ChooseDumpPoint, Machine("zx200", yard), records)
    found = records.of["zx200", "dump_point"]
    assert found["truck"] == "ic120" and found["number"] == 3
    assert (found["bank"], found["before"]) == (pytest.approx(0.6), pytest.approx(0.8))
    assert 3.0 < found["x"] < 4.2 and abs(found["y"]) < 1.5 and found["z"] > 4.0


@pytest.mark.parametrize("why", ["far", "full", "moving"])
def test_it_waits_for_one(yard: Yard, records: Records, why: str) -> None:
    yard.places["ic120"] = (20.0, 0.0, 0.0) if why == "far" else AT_FACE
    yard.carried["ic120"] = 5.8 if why == "full" else 0.0
    looks = 0

    def let_time_pass() -> None:
        nonlocal looks
        looks += 1
        if why == "moving" and looks <= 4:
            yard.places["ic120"] = (AT_FACE[0] + 0.1 * looks, *AT_FACE[1:])
        elif looks == 5:
            yard.places["ic120"], yard.carried["ic120"] = AT_FACE, 0.0

    yard.time_passes = let_time_pass
    said = execute(ChooseDumpPoint, machine := Machine("zx200", yard), records)
    assert looks >= 5 and machine.checks >= 2, "a cancel is heard meanwhile"
    assert said and records.of["zx200", "dump_point"]["truck"] == "ic120"


def test_the_bucket_counts_once(yard: Yard, records: Records) -> None:
    yard.carried["ic120"] = 1.0  # 0.8 m3 as it lay: 0.4 more
    for _ in range(2):
        execute(DigAgainUntil, Machine("zx200", yard), records)
    job = records.of["", "EARTHWORK"]
    assert (job["moved"], job["counted"], job["done"]) == (pytest.approx(0.8), 2, False)
    yard.level = -1.5
    execute(DigAgainUntil, Machine("zx200", yard), records)
    assert job["done"] and job["counted"] == 2, "nothing is left"


@pytest.mark.parametrize(
    ("load", "number", "done", "goes"),
    [(5.4, 1, False, True), (5.4, 2, False, False), (2.0, 1, False, False), (2.0, 1, True, True)],
    ids=["full", "a bucket is over it", "not full", "the job is done"],
)
def test_a_truck_stands_until_it_is_loaded(
    yard: Yard, records: Records, load: float, number: int, done: bool, goes: bool
) -> None:
    yard.carried["ic120"] = load
    records.of["zx200", "dump_point"]["number"] = number
    records.of["", "EARTHWORK"]["done"] = done
    machine = Machine("ic120", yard)
    machine.gives_up = True
    want = Loading(excavator="zx200", job="EARTHWORK")
    if goes:
        execute(WaitUntilLoaded, machine, records, want)
    else:
        with pytest.raises(SubtaskCancelled):
            execute(WaitUntilLoaded, machine, records, want)
