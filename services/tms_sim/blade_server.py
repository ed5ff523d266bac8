"""The action that brings a bulldozer's blade to angles; its controller holds them in any case."""

from tms_msg_rp.action import TmsRpBulldozerBlade

from tms_control.reference_trajectory import Knot
from tms_sim.controller import Controller, TrajectoryMotion
from tms_sim.motion import SUCCEEDED, MotionVerdict
from tms_sim.servers import ActionHandler

SLACK = 2.0  # times what the joint that has furthest to go needs at its limit of speed


def blade_server(controller: Controller) -> ActionHandler:
    """TmsRpBulldozerBlade on a controller."""
    arm, action = controller.arm, TmsRpBulldozerBlade

    def knots(request: TmsRpBulldozerBlade.Goal) -> list[Knot]:
        pairs = dict(zip(request.joint_name, request.goal_position, strict=False))
        needed = [
            abs(angle - arm.servos[name].position) / arm.joints[name].velocity
            for name, angle in pairs.items() if name in arm.joints
        ]  # fmt: skip
        return [Knot(1.0 + SLACK * max(needed, default=0.0), tuple(request.goal_position), ())]

    def refusal(request: TmsRpBulldozerBlade.Goal) -> tuple[int, str] | None:
        return controller.refusal(list(request.joint_name), knots(request))

    def begin(request: TmsRpBulldozerBlade.Goal) -> TrajectoryMotion:
        return controller.begin(list(request.joint_name), knots(request))

    def feedback(motion: TrajectoryMotion) -> TmsRpBulldozerBlade.Feedback:
        apart = [end - now for end, now in zip(motion.reference.end, arm.positions, strict=True)]
        return action.Feedback(current_error=apart)

    def result(_motion: TrajectoryMotion, verdict: MotionVerdict) -> TmsRpBulldozerBlade.Result:
        return action.Result(success=verdict.outcome == SUCCEEDED)

    return ActionHandler("set_bulldozer_blade", action, refusal, begin, controller.cancel, feedback, result)
