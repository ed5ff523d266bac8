"""Arms and vessels of OperaSim under our controller, in virtual time: what it reaches, and how it ends."""

import math
from dataclasses import dataclass, replace

import pytest

from tms_config.models import Joint, Response
from tms_control.arm_controller import ArmController
from tms_control.arm_motion import GOAL_VIOLATED, PATH_VIOLATED, ArmMotion, Ending, Tolerances, Verdict
from tms_control.reasons import OffReference, ShortOfGoal, TakenOver
from tms_control.reference_trajectory import Knot, ReferenceTrajectory
from unit.tms_control.plant_rig import STEP, Plant

WORST, SETTLED = 0.05, 0.5  # rad, s: what is promised
LEAVES = 70.0  # s after which a goal must have ended
CANCELLED = Verdict(Ending.CANCELED)
NONE = Tolerances()


def response(model: str, plant: Plant) -> dict[str, Response]:
    """As the border of OperaSim has it: a zx120 has no dead time there, and its boom hangs."""
    if model != "zx120":
        return dict(plant.model.response)
    hangs = {"boom_joint": -0.1}
    return {name: replace_response(one, hangs.get(name, 0.0)) for name, one in plant.model.response.items()}


def replace_response(one: Response, droop: float) -> Response:
    return one.model_copy(update={"dead_time": 0.0, "droop": droop})


@dataclass
class Seen:
    """What a move has shown."""

    worst: float = 0.0  # rad
    settled: float = 0.0  # s after the end of the reference


class Rig:
    """A controller at 50 Hz that hears of the joints at 25 Hz."""

    def __init__(self, model: str, *, lag: float = 1.0, dead_time: float = 0.0) -> None:
        self.plant = Plant(model, lag=lag, dead_time=dead_time)
        self.arm = ArmController(self.plant.model.joints, response(model, self.plant))
        self.sent: dict[str, float] = {}
        self._ticks = 0

    def tick(self) -> None:
        """One period."""
        self._ticks += 1
        if self._ticks % 2:
            self.arm.measured(self.plant.now, self.plant.positions, self.plant.velocities)
        self.sent = self.arm.step(self.plant.now)
        if self.sent:
            self.plant.send(self.sent)
        self.plant.step()

    def begin(self, joint: str, way: float, tolerances: Tolerances = NONE) -> ArmMotion:
        """Move one joint by `way` rad as a planner would: at rest at both ends."""
        now = self.plant.positions
        self.arm.measured(self.plant.now, now, self.plant.velocities)
        goal = {**now, joint: now[joint] + way}
        seconds = _duration(self.plant.model.joints[joint], abs(way))
        points = [_knot(now, goal, share / 20, seconds) for share in range(21)]
        reference = ReferenceTrajectory(self.plant.model.joints, points[0], list(now), points)
        return self.arm.begin(self.plant.now, reference, tolerances)

    def until(self, motion: ArmMotion, joint: str = "") -> Seen:
        """Go on until the goal has ended, and for a second more."""
        seen, ends = Seen(), motion.begun + motion.reference.duration
        left = LEAVES
        while left > 0.0 and (motion.verdict is None or self.plant.now < ends + 1.0):
            self.tick()
            left -= STEP
            if joint:
                off = abs(self.plant.positions[joint] - self._wanted(motion, joint))
                seen.worst = max(seen.worst, off)
                seen.settled = self.plant.now - ends if off > 0.03 else seen.settled
        assert motion.verdict is not None, "it does not end"
        return seen

    def _wanted(self, motion: ArmMotion, joint: str) -> float:
        return motion.reference.joint(list(self.plant.model.joints).index(joint), self.plant.now - motion.begun)


def _duration(joint: Joint, way: float) -> float:
    return 1.1 * max(1.5 * way / joint.velocity, math.sqrt(6 * way / joint.acceleration))


def _knot(begin: dict[str, float], end: dict[str, float], share: float, seconds: float) -> Knot:
    way, speed = share * share * (3 - 2 * share), 6 * share * (1 - share) / seconds
    return Knot(
        share * seconds,
        tuple(begin[name] + (end[name] - begin[name]) * way for name in begin),
        tuple((end[name] - begin[name]) * speed for name in begin),
    )


MOVES = [
    ("zx200", "swing_joint", 1.2), ("zx200", "boom_joint", 0.5), ("zx200", "arm_joint", -0.6),
    ("zx120", "boom_joint", 0.4), ("ic120", "vessel_pin_joint", -0.5), ("mst110cr", "rotate_joint", 0.8),
]  # fmt: skip


@pytest.mark.parametrize(("model", "joint", "way"), MOVES)
def test_a_known_drive_follows_from_the_first_move(model: str, joint: str, way: float) -> None:
    rig = Rig(model)
    motion = rig.begin(joint, way)
    seen = rig.until(motion, joint)
    assert motion.verdict == Verdict(Ending.SUCCEEDED)
    assert seen.worst <= WORST and seen.settled <= SETTLED


@pytest.mark.parametrize(("model", "joint", "way"), MOVES)
def test_an_unknown_drive_follows_after_two_moves(model: str, joint: str, way: float) -> None:
    rig = Rig(model, lag=1.3, dead_time=0.05)
    known = rig.arm.servos[joint].dead_time
    for turn in (way, -way):
        rig.until(rig.begin(joint, turn))
    seen = rig.until(rig.begin(joint, way), joint)
    assert seen.worst <= WORST and seen.settled <= SETTLED
    assert rig.arm.servos[joint].dead_time > known


def test_it_does_not_follow_without_what_it_learns() -> None:
    """The floor of the two tests above: with figures that are wrong, errors are larger than promised."""
    rig = Rig("zx200", lag=1.3, dead_time=0.05)
    assert rig.until(rig.begin("arm_joint", -0.6), "arm_joint").worst > WORST


def test_nothing_is_sent_without_a_goal() -> None:
    rig = Rig("zx200")
    rig.tick()
    assert rig.sent == {}
    rig.until(rig.begin("bucket_joint", 0.3))
    rig.tick()
    assert rig.sent == {}


def test_each_message_commands_all_joints_but_the_passive_one() -> None:
    rig = Rig("zx200")
    rig.begin("bucket_joint", 0.3)
    rig.tick()
    assert list(rig.sent) == ["swing_joint", "boom_joint", "arm_joint", "bucket_joint"]


def test_cancelled_it_ramps_down_and_holds() -> None:
    rig = Rig("zx200")
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
    rig = Rig("zx200")
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
    rig = Rig("ic120")
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
    rig = Rig("zx200")
    rig.begin("swing_joint", 1.2)
    rig.tick()
    rig.arm.cancel(rig.plant.now, CANCELLED)
    rig.arm.silence(rig.plant.now, CANCELLED)
    rig.tick()
    assert rig.sent == {}


def test_a_newer_goal_takes_over() -> None:
    rig = Rig("zx200")
    first = rig.begin("bucket_joint", 0.5)
    rig.tick()
    second = rig.begin("bucket_joint", 0.3)
    rig.until(second)
    assert first.verdict == Verdict(Ending.ABORTED, reason=TakenOver())
    assert second.verdict == Verdict(Ending.SUCCEEDED)


def test_a_joint_that_does_not_arrive_ends_its_goal() -> None:
    rig = Rig("zx200")
    motion = rig.begin("boom_joint", 0.5, replace(NONE, seconds=3.0))
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.2)
    rig.until(motion)
    assert motion.verdict is not None and motion.verdict.code == GOAL_VIOLATED
    assert isinstance(motion.verdict.reason, ShortOfGoal) and motion.verdict.reason.joint == "boom_joint"


def test_a_joint_off_its_path_ends_its_goal_if_that_is_asked() -> None:
    rig = Rig("zx200")
    motion = rig.begin("boom_joint", 0.5, replace(NONE, path={"boom_joint": 0.1}))
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.1)
    rig.until(motion)
    assert motion.verdict is not None and motion.verdict.code == PATH_VIOLATED
    assert isinstance(motion.verdict.reason, OffReference)


def test_a_goal_may_have_no_tolerance_at_its_end() -> None:
    rig = Rig("zx200")
    motion = rig.begin("boom_joint", 0.5, replace(NONE, goal={"boom_joint": -1.0}))
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.2)
    rig.until(motion)
    assert motion.verdict == Verdict(Ending.SUCCEEDED)


def test_an_end_stop_teaches_no_droop_without_limit() -> None:
    rig = Rig("zx200")
    rig.plant.block("boom_joint", rig.plant.positions["boom_joint"] + 0.2)
    rig.until(rig.begin("boom_joint", 0.5, replace(NONE, seconds=20.0)))
    assert abs(rig.sent["boom_joint"] - rig.plant.positions["boom_joint"]) < 1.0
