"""A subtask as it would go: its goals for the arm are planned and checked, one after another, and nothing moves."""

from collections.abc import Callable, Mapping
from typing import Any

from tms_msg_rp.srv import CheckMotion
from trajectory_msgs.msg import JointTrajectory

from tms_config.models import MachineModel
from tms_interfaces.generated import ActionType, F, G, R
from tms_kit.machine import Machine
from tms_kit.subtask import load
from tms_kit.yard import Yard
from tms_machine.goal_inputs import Inputs
from tms_machine.values import Value
from tms_reason.errors import SubtaskFailed
from tms_reason.wire import refusal
from tms_ros.node import Ros
from tms_ros.packing import pack

TIMEOUT = 60.0  # s for all goals of a subtask
STAYS = ("_plan", "plan_pose")  # how the names of actions end that plan a motion and leave it at that
Values = Mapping[str, Any]
Check = Callable[[CheckMotion.Request], CheckMotion.Response]


def service_of(machine: str) -> str:
    """The CheckMotion service of a machine's planner."""
    return f"/{machine}/rp/check_motion"


class NotOfArm(Exception):
    """A subtask asks for something else than a motion of the arm."""


class Refused(SubtaskFailed):
    """The planner would refuse a goal.

    `lasting`: for the machine's own limits or body, so that it does not help to wait.
    """

    def __init__(self, answer: CheckMotion.Response) -> None:
        super().__init__(refusal(answer.error_code, answer.error_msg))
        self.lasting = bool(answer.lasting)


class Rehearsal(Machine):
    """An excavator in front of subtasks; `answers` are those of its planner, the newest last.

    `check` asks the planner. The arm begins where it is now, each motion where the last one has ended. What is
    written into records is kept here, and read by the subtasks that follow.
    """

    def __init__(self, ros: Ros, name: str, model_name: str, model: MachineModel, check: Check) -> None:
        super().__init__(ros, name, model_name, model, TIMEOUT)
        self._check = check
        self.answers: list[CheckMotion.Response] = []
        self._at = JointTrajectory()  # the last motion
        self._written: dict[tuple[str, str], dict[str, Any]] = {}

    def rehearse(self, subtask: str, record: str, inputs: Inputs, read: Callable[[str, str], Values]) -> None:
        """Let a subtask of the model run with a record; `read` gives the fields of a record of a machine.

        Raises:
            NotOfArm: this subtask does more, or something else.
            Refused, SubtaskFailed, RosError: why it would fail.
            ValidationError: the record does not fit.
        """
        use = self.model.subtask(subtask)
        kind = load(use.run)

        def fields(model_name: str, record_name: str, _max_age: float = 0.0) -> dict[str, Value]:
            return {**read(model_name, record_name), **self._written.get((model_name, record_name), {})}

        def write(model_name: str, record_name: str, values: Mapping[str, Value], _create: bool) -> None:
            self._written.setdefault((model_name, record_name), {}).update(values)

        want = None
        if kind.params is not None:
            values = {} if "," in record else fields(self.name, record)
            want = kind.params.model_validate({**values, **inputs, **use.inputs})
        kind(self, want, fields, write).execute(self.name, record, lambda _: None)

    def act(
        self, action_type: ActionType[G, R, F], action: str, goal: G, received: Callable[[F], None] | None = None
    ) -> R:
        """Have the planner check a goal instead of sending it."""
        ours = f"tms_rp_{self._model_name}_"
        if not action.startswith(ours):
            raise NotOfArm
        request = CheckMotion.Request(action=action.removeprefix(ours), goal=pack(goal), previous=self._at)
        answer = self._check(request)
        if answer.error_code:
            raise Refused(answer)
        self.answers.append(answer)
        if not action.endswith(STAYS):
            self._at = answer.plan
        result = action_type.Result()
        if hasattr(result, "plan"):
            result.plan = answer.plan
        return result

    @property
    def yard(self) -> Yard:
        """What is around the machine changes until the subtask runs."""
        raise NotOfArm

    def angle_of(self, joint: str) -> float:
        """The angle of a joint [rad] after the motions so far."""
        if not self._at.points:
            return super().angle_of(joint)
        return float(self._at.points[-1].positions[list(self._at.joint_names).index(joint)])
