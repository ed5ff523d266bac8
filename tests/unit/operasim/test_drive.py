"""Joints of the stand-in of OperaSim-PhysX, in virtual time, against the figures known of its prefabs."""

import math
from collections.abc import Callable
from itertools import pairwise

import pytest

from operasim.drive import Drive, DriveModel
from operasim.machine import Machine
from operasim.model import Placed, Unknowns, machine

STEP = 0.02
PLACED = (0.0, 0.0, 0.0)


def made(model: str, **unknowns: float) -> Machine:
    """A machine whose joints stand where a test puts them."""
    return Machine(machine(model), Placed(model=model, place=PLACED), Unknowns(**unknowns))


def joint(of: Machine, name: str) -> Drive:
    found = of.joints[name]
    assert found is not None
    return found


def stand(drive: Drive, at: float) -> None:
    drive.target = drive.position = at
    drive.velocity = 0.0


def run(of: Machine, seconds: float, seen: Callable[[float], None] = lambda now: None, begin: float = 0.0) -> float:
    """Let it go on for some seconds; returns the time then."""
    steps = round(seconds / STEP)
    for i in range(1, steps + 1):
        now = begin + i * STEP
        of.scripts(now)
        of.physics(STEP)
        seen(now)
    return begin + steps * STEP


def step_response(
    model: str, name: str, begin: float, end: float, by: str, **unknowns: float
) -> tuple[list[float], list[float]]:
    """Times at which 63 % and 95 % of the way are done, and the speeds on it."""
    one = made(model, **unknowns)
    drive = joint(one, name)
    stand(drive, begin)
    if by == "front":
        one.joint_cmd([name], [end], 0.0)
    else:
        one.angle(name, end)
    done: list[tuple[float, float]] = []
    speeds: list[float] = []

    def seen(now: float) -> None:
        done.append((now, abs(drive.position - begin)))
        speeds.append(abs(drive.velocity))

    run(one, 60.0, seen)
    way = done[-1][1]  # gravity makes it fall short
    return [next(now for now, gone in done if gone >= part * way) for part in (0.632, 0.95)], speeds


@pytest.mark.parametrize(
    ("model", "name", "begin", "end", "way", "at_63", "at_95"),
    [
        ("zx200", "swing_joint", 0.0, 1.0, "front", 2.5, 4.5),
        ("zx200", "boom_joint", 0.0, -1.0, "front", 1.78, None),
        ("zx200", "arm_joint", 1.0, 2.0, "front", 1.45, None),
        ("zx200", "bucket_joint", 0.0, 1.0, "front", 0.82, None),
        ("ic120", "vessel_pin_joint", 0.0, -1.0, "angle", 5.0, 15.0),
    ],
)
def test_step_response(
    model: str, name: str, begin: float, end: float, way: str, at_63: float, at_95: float | None
) -> None:
    (most, all_but), _ = step_response(model, name, begin, end, way)
    assert most == pytest.approx(at_63, rel=0.04)
    if at_95 is not None:
        assert all_but == pytest.approx(at_95, rel=0.04)


def test_the_swing_is_held_back_by_its_torque() -> None:
    _, speeds = step_response("zx200", "swing_joint", 0.0, 1.0, "front")
    assert max(speeds) == pytest.approx(0.67, abs=0.03)
    gains = [after - before for before, after in pairwise(speeds)]
    assert max(gains) / STEP == pytest.approx(0.68, abs=0.01)  # rad/s2: 68000 N m on 1e5 kg m2


@pytest.mark.parametrize(
    ("model", "name", "lag"),
    [
        ("zx200", "bucket_joint", 0.5), ("zx200", "arm_joint", 1.0), ("mst110cr", "rotate_joint", 1.0),
        ("mst110cr", "dump_joint", 1.0), ("ic120", "vessel_pin_joint", 5.0), ("zx120", "swing_joint", 1.0),
        ("zx120", "arm_joint", 1.0), ("zx120", "boom_joint", 0.75), ("zx120", "bucket_joint", 1.0),
        ("c30r", "vessel_joint", 1.0),
    ],
)  # fmt: skip
def test_speed_is_error_by_lag(model: str, name: str, lag: float) -> None:
    drive = joint(made(model, droop=0.0), name)
    begin = math.degrees(0) if name in ("swing_joint", "rotate_joint") else sum(limits(drive)) / 2
    stand(drive, begin)
    drive.target = begin + 0.2
    for _ in range(25):
        drive.step(STEP)
    assert drive.velocity == pytest.approx((drive.target - drive.position) / lag, rel=0.06)


def limits(drive: Drive) -> tuple[float, float]:
    return drive.model.low, drive.model.high


@pytest.mark.parametrize(
    ("name", "dead_time"),
    [("swing_joint", 0.932), ("boom_joint", 0.6495), ("arm_joint", 0.4255), ("bucket_joint", 0.31)],
)
def test_dead_times(name: str, dead_time: float) -> None:
    one = made("zx200")
    for of in one.joints:
        if (drive := one.joints[of]) is not None:
            stand(drive, drive.model.low if math.isfinite(drive.model.low) else 0.0)
    aim = joint(one, name)
    one.joint_cmd([name], [1.0], 0.0)
    aimed: list[float] = []
    run(one, 2.0, lambda now: aimed.append(now) if aim.target == 1.0 else None)
    assert dead_time < aimed[0] <= dead_time + STEP


@pytest.mark.parametrize(
    ("model", "name", "droop"),
    [("zx200", "boom_joint", 0.0015), ("ic120", "vessel_pin_joint", 0.0115), ("zx120", "boom_joint", 0.1)],
)
def test_droop(model: str, name: str, droop: float) -> None:
    for factor in (1.0, 0.0):
        one = made(model, droop=factor)
        drive = joint(one, name)
        stand(drive, -0.5)
        run(one, 40.0)
        assert drive.position + 0.5 == pytest.approx(factor * droop, abs=2e-4)


def test_lag_and_dead_time_may_be_off() -> None:
    _, speeds = step_response("zx200", "bucket_joint", 0.0, 1.0, "front", lag=1.3, dead_time=0.04)
    first = next(i for i, speed in enumerate(speeds) if speed > 0.01)
    assert 0.35 < (first + 1) * STEP < 0.35 + STEP + 1e-9
    assert max(speeds) == pytest.approx(1 / 0.65, rel=0.06)


def test_end_stops_are_hard_and_the_target_is_not_limited() -> None:
    one = made("zx200")
    drive = joint(one, "bucket_joint")
    drive.target = 5.0
    run(one, 10.0)
    assert (drive.position, drive.velocity, drive.target) == (math.radians(136), 0.0, 5.0)


def test_all_begin_at_zero_and_move_to_their_first_targets() -> None:
    one = made("zx200")
    assert [drive.position for drive in one.joints.values() if drive is not None] == [0.0] * 4
    arm = joint(one, "arm_joint")
    run(one, 0.2)
    assert 0.0 < arm.position < arm.model.low  # from outside its end stop
    run(one, 9.8)
    places = [drive.position for drive in one.joints.values() if drive is not None]
    assert places == pytest.approx([0.0, -0.6981 + 0.0015, 1.5708, 0.7854], abs=2e-3)


def test_the_original_would_be_unstable_by_explicit_steps() -> None:
    drive = Drive(DriveModel(1e8, 1e8, 68000, 1e5), 0.5)
    seen = []
    for _ in range(500):
        drive.step(STEP)
        seen.append(drive.position)
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(0.5, abs=1e-3)


def test_drive_params_change_the_bucket_only() -> None:
    one = made("zx200")
    one.drive_params("bucket_joint", 1e7, 2e7)
    drive = joint(one, "bucket_joint")
    stand(drive, 0.0)
    drive.target = 1.0
    run(one, 0.5)
    assert drive.velocity == pytest.approx((1.0 - drive.position) / 2.0, rel=0.05)
    assert joint(one, "arm_joint").damping == 2e7
