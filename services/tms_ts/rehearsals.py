"""Has the planners check the motions of a task before it runs, each from where the one before it leaves the arm."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from pydantic import ValidationError
from tms_msg_rp.srv import CheckMotion

from tms_config.clock import monotonic
from tms_kit.rehearsal import NotOfArm, Refused, Rehearsal, service_of
from tms_machine.goal_inputs import Inputs
from tms_reason.errors import RosError, SubtaskFailed
from tms_reason.reason import Reason
from tms_runtime.app import App
from tms_ts.preflight import Refusal
from tms_ts.reasons import MotionsUnplanned

SECONDS = 2.0  # for all motions of a task, and for one that is under way then: most take a hundredth of it


class _Unplanned(Exception):
    """There is no time for a motion, or nobody to ask."""


class Rehearsals:
    """Those of one preflight, in the order of the document. `read`: the fields of a record of a machine."""

    def __init__(self, app: App, read: Callable[[str, str], Mapping[str, Any]]) -> None:
        self._app, self._read, self._until = app, read, monotonic() + SECONDS
        self._arms: dict[str, Rehearsal] = {}
        self._left = 0  # motions that were not planned

    def refusal(self, machine: str, subtask: str, record: str, inputs: Inputs) -> Refusal | None:
        """Why the planner of a machine would refuse what a subtask asks for; None if it would not, or is not asked."""
        model = self._app.site.model_of(machine)
        if model.planner is None:
            return None
        if machine not in self._arms:
            name, check = self._app.site.file.machines[machine].model, partial(self._check, service_of(machine))
            self._arms[machine] = Rehearsal(self._app.ros, machine, name, model, check)
        try:
            self._arms[machine].rehearse(subtask, record, inputs, self._read)
        except Refused as error:
            return Refusal(error.reason, error.lasting)
        except (_Unplanned, RosError):
            self._left += 1
        except (NotOfArm, SubtaskFailed, ValidationError):
            pass  # no motion of the arm, or the record does not tell it yet
        return None

    def unplanned(self) -> list[Reason]:
        """What was not planned."""
        return [MotionsUnplanned(self._left)] if self._left else []

    def _check(self, service: str, request: CheckMotion.Request) -> CheckMotion.Response:
        if monotonic() > self._until or not self._app.ros.has_service(CheckMotion, service):
            raise _Unplanned
        return self._app.ros.call(CheckMotion, service, request, SECONDS)
