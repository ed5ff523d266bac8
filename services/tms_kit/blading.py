"""Capability of bulldozers: a blade."""

from collections.abc import Mapping

from tms_msg_rp.action import TmsRpBulldozerBlade

from tms_kit.acting import Acting, Progress
from tms_machine.reasons import BladeNotThere, Turning
from tms_reason.errors import SubtaskFailed


class Blading(Acting):
    """Angles [rad] of the joints of a blade."""

    def set_blade(self, progress: Progress, angles: Mapping[str, float], hold: bool) -> None:
        """Bring the blade to angles; with `hold` the machine goes on commanding them until the next goal.

        Raises:
            SubtaskFailed: BladeNotThere, or as every motion.
        """

        def received(feedback: TmsRpBulldozerBlade.Feedback) -> None:
            progress(Turning(max(map(abs, feedback.current_error), default=0.0)))

        goal = TmsRpBulldozerBlade.Goal(
            joint_name=list(angles), control_type=TmsRpBulldozerBlade.Goal.POSITION,
            goal_position=list(angles.values()), blade_hold=hold,
        )  # fmt: skip
        if not self.guarded("set_bulldozer_blade", TmsRpBulldozerBlade, goal, received).success:
            raise SubtaskFailed(BladeNotThere(self.name))
