"""Answers preflight: the present records, and the servers, machines, runs and sensing inputs that exist."""

from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError
from tms_msg_db.msg import Record
from tms_msg_db.srv import ListParameters
from tms_msg_sp.msg import InputState, InputStates

from tms_config.clock import monotonic, sleep, unix_time
from tms_config.models import MachineModel
from tms_kit.subtask import load
from tms_machine import stamps
from tms_machine.asking import ask
from tms_machine.goal_inputs import Inputs
from tms_machine.leaf_forms import misfit, own_action
from tms_machine.values import from_parameters
from tms_reason.reason import Reason
from tms_reason.validation import explain
from tms_runtime.app import App
from tms_ts.preflight import Refusal, StoredRecord
from tms_ts.reasons import JointUnfit
from tms_ts.rehearsals import Rehearsals

DB_LIMIT = 5.0  # s
DISCOVERY_LIMIT = 1.5  # s, for one preflight as a whole
CHECK_PERIOD = 0.05  # s
DEAF = ("silent", "waiting")  # states of an input that does not write


class SensingInputs:
    """The sensing inputs as tms:sp publishes them."""

    def __init__(self, app: App) -> None:
        self._inputs: list[InputState] = []
        app.ros.subscribe(InputStates, "/tms/sp/inputs", self._received, latched=True)

    def _received(self, message: InputStates) -> None:
        self._inputs = list(message.inputs)

    def writes(self, record: str) -> bool:
        """Whether an input has written a record (MODEL/RECORD) lately."""
        return any(record in one.records and one.state not in DEAF for one in self._inputs)

    def silent(self, record: str) -> str:
        """An input that wrote a record and does not any more."""
        return next((one.name for one in self._inputs if record in one.records and one.state in DEAF), "")


class PreflightContext:
    """The surroundings of one preflight; reads all records once.

    Raises:
        RosError: the database does not answer.
    """

    def __init__(
        self,
        app: App,
        sensing: SensingInputs,
        problem: Callable[[str], Reason | None],
        writers: Callable[[str, str], bool],
        motions: bool,
    ) -> None:
        """`motions`: the planners are asked about them, for two seconds at most."""
        self._app, self._sensing, self.problem, self._writers = app, sensing, problem, writers
        answer = ask(app.ros, ListParameters, "/tms/db/list_parameters", ListParameters.Request(), DB_LIMIT)
        now = unix_time()
        self._found_by = monotonic() + DISCOVERY_LIMIT
        self._records = {(record.model_name, record.record_name): _stored(record, now) for record in answer.records}
        self._motions = motions
        self._rehearsals = Rehearsals(app, lambda *name: self._records[name].values if name in self._records else {})

    def record(self, machine: str, record: str) -> StoredRecord | None:
        return self._records.get((machine, record))

    def names(self, machine: str) -> list[str]:
        return [record for of, record in self._records if of == machine]

    def served(self, machine: str, subtask: str) -> bool:
        """Whether the ROS graph has an action server of that name, of any system; waits for one that has just begun."""
        _, name = own_action(self._app.site, machine, subtask)  # which `<machine>:if` serves for peers of version 6
        status, count = f"{name}/_action/status", self._app.ros.node.count_publishers
        while not (found := count(status)) and monotonic() < self._found_by:
            sleep(CHECK_PERIOD)
        return bool(found)

    def misread(self, machine: str, subtask: str) -> Reason | None:
        return misfit(self._app.ros, self._app.site, machine, subtask, servers=True)

    def written(self, record: str, field: str) -> bool:
        return self._writers(record, field) or self._sensing.writes(f"/{record}")

    def silent(self, machine: str, record: str) -> str:
        return self._sensing.silent(f"{machine}/{record}")

    def unfit(self, machine: str, subtask: str, values: Mapping[str, Any], inputs: Inputs) -> Reason | None:
        return unfit(self._app.site.model_of(machine), subtask, values, inputs)

    def oldest(self, machine: str, subtask: str) -> float:
        return self._app.site.model_of(machine).subtask(subtask).max_age

    def refusal(self, machine: str, subtask: str, record: str, inputs: Inputs) -> Refusal | None:
        return self._rehearsals.refusal(machine, subtask, record, inputs) if self._motions else None

    def unplanned(self) -> list[Reason]:
        return self._rehearsals.unplanned()


def unfit(model: MachineModel, subtask: str, values: Mapping[str, Any], inputs: Inputs) -> Reason | None:
    """Why a subtask cannot use a record and the inputs of a goal: a field, or an angle beyond its joint's limit."""
    use = model.subtask(subtask)
    kind = load(use.run)
    if (why := kind.not_taken(inputs)) is not None or kind.params is None:
        return why
    try:
        angles = kind.params.model_validate({**values, **inputs, **use.inputs}).joint_angles()
    except ValidationError as error:
        return explain(error)
    broken = ((name, model.joints[name].violation(angle)) for name, angle in angles.items() if name in model.joints)
    return next((JointUnfit(name, why) for name, why in broken if why is not None), None)


def _stored(record: Record, now: float) -> StoredRecord:
    stamp = record.updated_at
    age = now - stamps.seconds(stamp) if stamp.sec else None
    return StoredRecord(from_parameters(record.values), record.type, age, record.max_age)
