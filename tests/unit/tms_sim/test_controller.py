"""Goals of the stand-in controller: success, preemption, tolerance, cancel, emergency stop."""

import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.reference_trajectory import Knot
from tms_sim.arm import Arm
from tms_sim.controller import GOAL_VIOLATED, Controller, Motion

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
NAMES = tuple(MODEL.joints)
HERE = tuple(MODEL.initial[name] for name in NAMES)


def goal(swing: float, seconds: float = 4.0, boom: float = HERE[1]) -> list[Knot]:
    return [Knot(seconds, (swing, boom, *HERE[2:]))]


def run(controller: Controller, seconds: float) -> None:
    for _ in range(round(seconds / 0.02)):
        controller.step(0.02)


def outcome(motion: Motion) -> str | None:
    return motion.verdict.outcome if motion.verdict else None


@pytest.fixture
def controller() -> Controller:
    return Controller(Arm(MODEL.joints, MODEL.initial, {}))


def test_success_after_the_last_point_only(controller: Controller) -> None:
    motion = controller.begin(NAMES, goal(HERE[0]))  # it is there all the time
    run(controller, 3.9)
    assert outcome(motion) is None
    run(controller, 0.2)
    assert outcome(motion) == "SUCCEEDED"
    assert motion.over.is_set()


def test_cancel_ends_when_the_arm_stands(controller: Controller) -> None:
    motion = controller.begin(NAMES, goal(2.0))
    run(controller, 2.0)
    controller.cancel(motion)
    controller.step(0.02)
    assert outcome(motion) is None
    assert not controller.arm.still
    run(controller, 3.0)
    assert outcome(motion) == "CANCELED"
    assert controller.arm.still


def test_a_cancel_that_is_repeated_makes_it_no_slower() -> None:
    took = []
    for again in (False, True):
        controller = Controller(Arm(MODEL.joints, MODEL.initial, MODEL.response))
        motion = controller.begin(NAMES, goal(2.5))
        run(controller, 3.0)
        controller.cancel(motion)
        for tick in range(500):
            if again and tick % 5 == 0:
                controller.cancel(motion)  # as somebody does who does not see it stand
            controller.step(0.02)
            if motion.verdict:
                took.append(tick * 0.02)
                break
    assert took[1] == pytest.approx(took[0], abs=0.2)


def test_a_newer_goal_preempts(controller: Controller) -> None:
    old = controller.begin(NAMES, goal(2.0))
    run(controller, 1.0)
    new = controller.begin(NAMES, goal(0.0, 6.0))
    assert outcome(old) == "ABORTED"
    assert "preempted" in (old.verdict.text if old.verdict else "")
    controller.cancel(old)  # too late, and not its motion any more
    run(controller, 10.0)
    assert outcome(new) == "SUCCEEDED"


def test_a_goal_beyond_a_limit_is_never_reached(controller: Controller) -> None:
    motion = controller.begin(NAMES, goal(0.0, boom=0.5), goal_time=1.0)
    run(controller, 8.0)
    assert motion.verdict is not None
    assert (motion.verdict.outcome, motion.verdict.code) == ("ABORTED", GOAL_VIOLATED)
    assert motion.verdict.text == "boom_joint is 0.600 rad off its goal 1 s after its time"


def test_a_goal_is_done_when_the_machine_is_there_and_not_when_the_reference_ends() -> None:
    controller = Controller(Arm(MODEL.joints, MODEL.initial, MODEL.response))
    motion = controller.begin(NAMES, goal(0.8, 2.0))
    run(controller, 0.93 + 2.0)
    assert outcome(motion) is None
    for _ in range(500):
        controller.step(0.02)
        if motion.verdict:
            break
    assert outcome(motion) == "SUCCEEDED"
    assert abs(controller.arm.positions[0] - 0.8) <= 0.03
    assert abs(controller.arm.velocities[0]) <= 0.01


def test_cancel_ends_when_a_sluggish_arm_stands() -> None:
    controller = Controller(Arm(MODEL.joints, MODEL.initial, MODEL.response))
    motion = controller.begin(NAMES, goal(2.0))
    run(controller, 0.5)
    controller.cancel(motion)  # before anything moves: what is under way still plays
    run(controller, 0.5)
    assert outcome(motion) is None
    run(controller, 3.0)
    assert outcome(motion) == "CANCELED"
    assert all(abs(velocity) < 0.01 for velocity in controller.arm.velocities)


def test_emergency_stop_pressed_while_a_goal_arrives(controller: Controller) -> None:
    controller.stop(True)
    motion = controller.begin(NAMES, goal(2.0))
    run(controller, 0.1)
    assert outcome(motion) == "ABORTED"
    assert controller.arm.positions == list(HERE)
