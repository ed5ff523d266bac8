"""Capability of carriers: a vessel that tips and an upper body that turns."""

import threading
from typing import Any

from com3_msgs.action import SetDumpAngle, SetSwingAngle
from tms_msg_rc.msg import MachineState

from tms_kit.acting import Acting, Progress
from tms_machine.reasons import NoJointState, NotReached, Turning
from tms_reason.errors import SubtaskFailed

STATE_LIMIT = 2.0  # s for the gateway to report the joints


class Tipping(Acting):
    """Angles [rad] of vessel and upper body."""

    def set_dump_angle(self, progress: Progress, target_angle: float) -> None:
        """Tip the vessel to an angle [rad]: 0 lowered, negative raises."""
        self._turn("set_dump_angle", SetDumpAngle, target_angle, progress)

    def set_swing_angle(self, progress: Progress, target_angle: float) -> None:
        """Turn the upper body to an angle [rad] against the tracks."""
        self._turn("set_swing_angle", SetSwingAngle, target_angle, progress)

    def angle_of(self, joint: str) -> float:
        """The present angle of a joint [rad], as the gateway publishes it.

        Raises:
            SubtaskFailed: NoSuchJoint, or NoJointState within 2 s.
        """
        self.joint(joint)
        found: list[float] = []
        received = threading.Event()

        def on_state(state: MachineState) -> None:
            if state.ready and joint in state.joint_names:
                found.append(state.positions[list(state.joint_names).index(joint)])
                received.set()

        topic = f"/{self.name}/rc/state"
        subscription = self._ros.subscribe(MachineState, topic, on_state, latched=True)
        there = received.wait(STATE_LIMIT)
        self._ros.on_executor(lambda: self._ros.node.destroy_subscription(subscription))
        self.check()
        if not there:
            raise SubtaskFailed(NoJointState(joint, self.name, STATE_LIMIT, topic))
        return found[0]

    def _turn(self, field: str, action_type: Any, angle: float, progress: Progress) -> None:
        def received(feedback: Any) -> None:
            progress(Turning(feedback.current_error))

        result = self.guarded(field, action_type, action_type.Goal(target_angle=angle), received)
        if not result.success:
            raise SubtaskFailed(NotReached(self.name, angle, field))
