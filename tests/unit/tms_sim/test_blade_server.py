"""The blade of the stand-in of a bulldozer."""

import pytest
from tms_msg_rp.action import TmsRpBulldozerBlade

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_sim.arm import Arm
from tms_sim.blade_server import blade_server
from tms_sim.controller import Controller

MODEL = parse(CONFIGS / "machines" / "d37pxi.yaml", MachineModel)
NAMES = ["lift_joint", "tilt_joint", "angle_joint"]


def goal(*angles: float) -> TmsRpBulldozerBlade.Goal:
    return TmsRpBulldozerBlade.Goal(joint_name=NAMES, goal_position=list(angles))


def test_it_goes_to_the_angles_of_a_goal_and_stays_there() -> None:
    controller = Controller(Arm(MODEL.joints, {}, MODEL.response))
    handler = blade_server(controller)
    assert handler.refusal(goal(-0.3, 0.05, 0.1)) is None
    motion = handler.begin(goal(-0.3, 0.05, 0.1))
    assert max(map(abs, handler.feedback(motion).current_error)) == pytest.approx(0.3)
    for _ in range(2000):
        controller.step(0.02)
    assert motion.verdict is not None and handler.result(motion, motion.verdict).success
    there = dict(zip(controller.arm.joints, controller.arm.positions, strict=True))
    assert [there[name] for name in NAMES] == pytest.approx([-0.3, 0.05, 0.1], abs=0.01)


def test_it_refuses_lists_that_do_not_fit() -> None:
    handler = blade_server(Controller(Arm(MODEL.joints, {}, MODEL.response)))
    assert handler.refusal(goal(-0.3)) is not None
    assert handler.refusal(TmsRpBulldozerBlade.Goal(joint_name=["boom_joint"], goal_position=[0.0])) is not None
