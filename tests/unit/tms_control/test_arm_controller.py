"""Arms and vessels of OperaSim under our controller, in virtual time: what it reaches, and how it ends."""

from dataclasses import replace

import pytest

from driven_joints import NONE, DrivenJoints
from tms_control.arm_motion import GOAL_VIOLATED, PATH_VIOLATED
from tms_control.reasons import OffReference, ShortOfGoal, TakenOver
from tms_control.verdict import Ending, Verdict

WORST, SETTLED = 0.05, 0.5  # rad, s: what is promised
CANCELLED = Verdict(Ending.CANCELED)


MOVES = [
    ("zx200", "swing_joint", 1.2), ("zx200", "boom_joint", 0.5), ("zx200", "arm_joint", -0.6),
    ("zx120", "boom_joint", 0.4), ("ic120", "vessel_pin_joint", -0.5), ("mst110cr", "rotate_joint", 0.8),
]  # fmt: skip


@pytest.mark.parametrize(("model", "joint", "way"), MOVES)
def test_a_known_drive_follows_from_the_first_move(model: str, joint: str, way: float) -> None:
    rig = DrivenJoints(model)
    motion = rig.begin(joint, way)
    seen = rig.until(motion, joint)
    assert motion.verdict == Verdict(Ending.SUCCEEDED)
    assert seen.worst <= WORST and seen.settled <= SETTLED


@pytest.mark.parametrize(("model", "joint", "way"), MOVES)
def test_an_unknown_drive_follows_after_two_moves(model: str, joint: str, way: float) -> None:
    rig = DrivenJoints(model, lag=1.3, dead_time=0.05)
    known = rig.arm.servos[joint].dead_time
    for turn in (way, -way):
        rig.until(rig.begin(joint, turn))
    seen = rig.until(rig.begin(joint, way), joint)
    assert seen.worst <= WORST and seen.settled <= SETTLED
    assert rig.arm.servos[joint].dead_time > known


def test_it_does_not_follow_without_what_it_learns() -> None:
    """The floor of the two tests above: with figures that are wrong, errors are larger than promised."""
    rig = DrivenJoints("zx200", lag=1.3, dead_time=0.05)
    assert rig.until(rig.begin("arm_joint", -0.6), "arm_joint").worst > WORST


def test_nothing_is_sent_without_a_goal() -> None:
    rig = DrivenJoints("zx200")
    rig.tick()
    assert rig.sent == {}
    rig.until(rig.begin("bucket_joint", 0.3))
    rig.tick()
    assert rig.sent == {}


def test_each_message_commands_all_joints_but_the_passive_one() -> None:
    rig = DrivenJoints("zx200")
    rig.begin("bucket_joint", 0.3)
    rig.tick()
    assert list(rig.sent) == ["swing_joint", "boom_joint", "arm_joint", "bucket_joint"]


def test_cancelled_it_ramps_down_and_holds() -> None:
    rig = DrivenJoints("zx200")
    motion = rig.begin("swing_joint", 1.2)
    while abs(rig.plant.velocities["swing_joint"]) < 0.2:
        rig.tick()
    begun, turned = rig.plant.now, rig.plant.positions["swing_joint"]
    rig.arm.cancel(rig.plant.now, CANCELLED)
    rig.until(motion)
    limits, dead_time = rig.plant.model.joints["swing_joint"], rig.arm.servos["swing_joint"].dead_time
    assert motion.verdict is CANCELLED and rig.arm.stands
    assert turned < rig.plant.positions["swing_joint"] < turned + limits.velocity * (dead_time + 1.0)
    assert rig.plant.now - begun < 10.0
    stood = rig.plant.positions["swing_joint"]
    rig.plant.wait(5.0)
    assert rig.plant.positions["swing_joint"] == pytest.approx(stood, abs=0.01)


def test_silenced_it_sends_nothing_from_that_moment() -> None:
    rig = DrivenJoints("zx200")
    motion = rig.begin("swing_joint", 1.2)
    rig.tick()
    assert rig.sent
    rig.arm.silence(rig.plant.now, CANCELLED)
    rig.tick()
    assert rig.sent == {} and rig.arm.busy
    rig.until(motion)
    assert rig.sent == {} and motion.verdict is CANCELLED and rig.arm.stands


def test_silenced_and_then_alone_it_holds_the_joints() -> None:
    """The gateway has stopped the machine, and is lost before it has held a joint."""
    rig = DrivenJoints("ic120")
    motion = rig.begin("vessel_pin_joint", -0.6)
    while abs(rig.plant.velocities["vessel_pin_joint"]) < 0.1:
        rig.tick()
    rig.arm.silence(rig.plant.now, CANCELLED)
    rig.tick()
    held = rig.plant.positions["vessel_pin_joint"]
    rig.arm.cancel(rig.plant.now, Verdict(Ending.ABORTED))
    rig.until(motion)
    assert motion.verdict is CANCELLED
    assert rig.plant.positions["vessel_pin_joint"] == pytest.approx(held, abs=0.1)


def test_silenced_while_it_brakes_it_sends_nothing() -> None:
    rig = DrivenJoints("zx200")
    rig.begin("swing_joint", 1.2)
    rig.tick()
    rig.arm.cancel(rig.plant.now, CANCELLED)
    rig.arm.silence(rig.plant.now, CANCELLED)
    rig.tick()
    assert rig.sent == {}


def test_a_newer_goal_takes_over() -> None:
    rig = DrivenJoints("zx200")
    first = rig.begin("bucket_joint", 0.5)
    rig.tick()
    second = rig.begin("bucket_joint", 0.3)
    rig.until(second)
    assert first.verdict == Verdict(Ending.ABORTED, TakenOver())
    assert second.verdict == Verdict(Ending.SUCCEEDED)


def test_a_joint_that_does_not_arrive_ends_its_goal() -> None:
    rig = DrivenJoints("zx200")
    motion = rig.begin("boom_joint", 0.5, replace(NONE, seconds=3.0))
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.2)
    rig.until(motion)
    assert motion.verdict is not None and motion.verdict.code == GOAL_VIOLATED
    assert isinstance(motion.verdict.reason, ShortOfGoal) and motion.verdict.reason.joint == "boom_joint"


def test_a_joint_off_its_path_ends_its_goal_if_that_is_asked() -> None:
    rig = DrivenJoints("zx200")
    motion = rig.begin("boom_joint", 0.5, replace(NONE, path={"boom_joint": 0.1}))
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.1)
    rig.until(motion)
    assert motion.verdict is not None and motion.verdict.code == PATH_VIOLATED
    assert isinstance(motion.verdict.reason, OffReference)


def test_a_goal_may_have_no_tolerance_at_its_end() -> None:
    rig = DrivenJoints("zx200")
    motion = rig.begin("boom_joint", 0.5, replace(NONE, goal={"boom_joint": -1.0}))
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.2)
    rig.until(motion)
    assert motion.verdict == Verdict(Ending.SUCCEEDED)


def test_an_end_stop_teaches_no_droop_without_limit() -> None:
    rig = DrivenJoints("zx200")
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.2)
    rig.until(rig.begin("boom_joint", 0.5, replace(NONE, seconds=20.0)))
    assert abs(rig.sent["boom_joint"] - rig.plant.positions["boom_joint"]) < 1.0
