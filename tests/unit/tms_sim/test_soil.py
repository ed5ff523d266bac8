"""Soil slows a bucket, and stalls it, in the direction in which it met it; a machine stands as the ground lies."""

import math

import pytest

from earth_rig import model_of
from tms_config.models import Border, Joint, Response
from tms_config.site_file import Fault
from tms_control.links import placed, quaternion, turned
from tms_control.reference_trajectory import Knot
from tms_machine.geometry import yaw_of
from tms_sim.base import Leg
from tms_sim.drive import JointDrive
from tms_sim.frames import Chain
from tms_sim.machine import StandIn
from tms_sim.soil import LEVEL, Resistance, joints_in_soil, stance, turn_of

ZX200 = model_of("zx200")
NAMES = list(ZX200.joints)
D37PXI = model_of("d37pxi")
PUSHES = D37PXI.blade.force if D37PXI.blade else math.nan
FORCE = ZX200.bucket.force if ZX200.bucket else math.nan


def machine(ideal: bool = False) -> StandIn:
    return StandIn(ZX200, (0.0, 0.0, 0.0), Fault(), lambda: None, Border(), ideal=ideal)


def dig(made: StandIn, seconds: float, resistance: float, arm: float = 0.6) -> dict[str, list[float]]:
    """Bring boom and arm by some angle in 2 s; the soil resists a bucket that goes on into it, or stands."""
    here = made.arm.positions
    there = [q + {"arm_joint": arm, "boom_joint": 0.2}.get(name, 0.0) for name, q in zip(NAMES, here, strict=True)]
    zero = (0.0,) * len(NAMES)
    made.controller.begin(NAMES, [Knot(2.0, tuple(there), zero)])
    seen: dict[str, list[float]] = {name: [] for name in NAMES}
    for _ in range(round(seconds / 0.04)):
        back = made.arm.velocities[NAMES.index("arm_joint")] < 0.0
        made.feel(0.0 if back else resistance, LEVEL)
        made.step(0.04)
        for name, q in zip(NAMES, made.arm.positions, strict=True):
            seen[name].append(q)
    return seen


def test_soil_slows_the_joints_next_to_the_bucket() -> None:
    assert joints_in_soil(ZX200) == ("bucket_joint", "arm_joint")
    assert joints_in_soil(model_of("ic120")) == ()


@pytest.mark.parametrize("ideal", [False, True])
def test_soil_that_resists_delays_the_arm(ideal: bool) -> None:
    free, slow = dig(machine(ideal), 12.0, 0.0), dig(machine(ideal), 12.0, 0.5 * FORCE)
    assert free["boom_joint"][:50] == slow["boom_joint"][:50], "the boom is strong enough"
    way = [[q - one["arm_joint"][0] for q in one["arm_joint"]] for one in (free, slow)]
    half = [next(k for k, q in enumerate(one) if q > 0.3) for one in way]
    assert half[1] > half[0]
    assert all(b <= a + 1e-9 for a, b in zip(way[0][:45], way[1], strict=False)), "never ahead"
    assert way[1][-1] == pytest.approx(0.6, abs=0.02), "it gets there"


@pytest.mark.parametrize("ideal", [False, True])
def test_a_bucket_that_meets_more_than_it_can_take_stalls_and_comes_out_again(ideal: bool) -> None:
    made = machine(ideal)
    begin = made.arm.positions[NAMES.index("arm_joint")]
    dig(made, 1.6, 0.0)
    stuck = dig(made, 3.0, 1.2 * FORCE)["arm_joint"]
    assert max(stuck[2:]) - min(stuck[2:]) < 0.005, "it stands"
    assert stuck[-1] < begin + 0.6
    out = dig(made, 6.0, 1.2 * FORCE, arm=-0.3)["arm_joint"]
    assert out[-1] < stuck[-1] - 0.25, "back is free"


def driven(made: StandIn, v: float, seconds: float, resistance: float) -> float:
    """Speed [m/s] of the tracks after a command; soil resists a blade that goes on into it, or stands."""
    assert made.base is not None
    made.drive(v, 0.0)
    for _ in range(round(seconds / 0.04)):
        made.feel(0.0 if made.base.v < 0.0 else resistance, LEVEL)
        made.step(0.04)
    return made.base.v


@pytest.mark.parametrize("ideal", [False, True])
def test_a_blade_that_pushes_soil_slows_the_tracks_and_stalls_them(ideal: bool) -> None:
    made = StandIn(D37PXI, (0.0, 0.0, 0.0), Fault(), lambda: None, Border(), ideal=ideal)
    assert driven(made, 1.0, 8.0, 0.0) == pytest.approx(1.0, abs=0.01)
    assert driven(made, 1.0, 1.0, 0.4 * PUSHES) == pytest.approx(0.6, abs=0.01)
    assert driven(made, 0.3, 8.0, 0.4 * PUSHES) == pytest.approx(0.3, abs=0.01), "there is force enough for less"
    assert driven(made, 1.0, 0.2, 1.2 * PUSHES) == 0.0
    assert driven(made, -0.5, 8.0, 1.2 * PUSHES) == pytest.approx(-0.5, abs=0.01), "back is free"


def test_a_way_takes_longer_where_a_blade_pushes_soil() -> None:
    times = []
    for resistance in (0.0, 0.5 * PUSHES):
        made = StandIn(D37PXI, (0.0, 0.0, 0.0), Fault(), lambda: None, Border())
        assert made.navigator is not None and made.base is not None
        trip = made.navigator.begin([Leg(6.0, 0.0, 0.0)])
        while trip.verdict is None and made.time < 60.0:
            made.feel(resistance, LEVEL)
            made.step(0.04)
        assert made.base.x == pytest.approx(6.0, abs=0.1)
        times.append(made.time)
    assert times[1] > times[0] + 2.0


def test_silence_ends_a_resistance() -> None:
    made = machine()
    dig(made, 1.6, 1.2 * FORCE)
    before = made.arm.positions[NAMES.index("arm_joint")]
    made.step(6.0)
    assert made.arm.positions[NAMES.index("arm_joint")] > before + 0.3


def test_soil_brakes_a_fast_joint_at_once() -> None:
    soil, joint = Resistance(), Joint(min=-9.0, max=9.0, velocity=1.0, acceleration=0.1, jerk=1.0)
    drive = JointDrive(joint, Response(dead_time=0.0, lag=0.5, origin="test"), 0.0, soil)
    drive.send(5.0, 0.0)
    for tick in range(400):
        drive.step(0.01 * tick, 0.01)
    assert drive.velocity > 0.5
    soil.meet(0.0, drive.velocity)
    at = drive.position
    drive.step(4.0, 0.01)
    assert (drive.velocity, drive.position) == (0.0, at)
    assert not drive.still, "it still wants to go there"


def test_the_same_soil_gives_the_same_motion() -> None:
    assert dig(machine(), 4.0, 0.7 * FORCE) == dig(machine(), 4.0, 0.7 * FORCE)


@pytest.mark.parametrize("yaw", [0.0, 2.0, -3.0])
def test_it_stands_as_the_ground_lies(yaw: float) -> None:
    place = placed(3.0, -2.0, yaw)
    place[:3, :3] = place[:3, :3] @ turned("y", -0.2) @ turned("x", 0.1)
    found = stance(1.5, tuple(quaternion(place[:3, :3])))
    (base, *_) = Chain(ZX200, Border()).frames((3.0, -2.0, yaw), {}, found)
    assert base.xyz == (3.0, -2.0, 1.5)
    assert abs(sum(a * b for a, b in zip(base.turn, quaternion(place[:3, :3]), strict=True))) == pytest.approx(1.0)
    assert yaw_of(turn_of(1.0, found)) == pytest.approx(1.0), "it turns on the spot meanwhile"
