"""The actions that bring a carrier's vessel or upper body to an angle."""

from com3_msgs.action import SetDumpAngle, SetSwingAngle

from tms_config.models import TURNED
from tms_sim.motion import SUCCEEDED, MotionVerdict
from tms_sim.servers import ActionHandler
from tms_sim.turner import Turn, Turner

TYPES: dict[str, type[SetDumpAngle | SetSwingAngle]] = {
    "set_dump_angle": SetDumpAngle,
    "set_swing_angle": SetSwingAngle,
}


def turn_server(field: str, turner: Turner) -> ActionHandler:
    """SetDumpAngle or SetSwingAngle on one joint."""
    joint = next(name for name in TURNED[field] if name in turner.arm.joints)
    action = TYPES[field]

    def feedback(turn: Turn) -> SetDumpAngle.Feedback | SetSwingAngle.Feedback:
        return action.Feedback(current_error=turn.target - turner.angle(joint))

    def result(_turn: Turn, verdict: MotionVerdict) -> SetDumpAngle.Result | SetSwingAngle.Result:
        return action.Result(success=verdict.outcome == SUCCEEDED)

    return ActionHandler(
        field, action, lambda request: turner.refusal(joint, request.target_angle),
        lambda request: turner.begin(joint, request.target_angle), turner.cancel, feedback, result,
    )  # fmt: skip
