"""Move the arm along the plans of records, one behind the other, as one trajectory."""

from tms_kit.subtask import Params, Progress, Subtask, SubtaskFailed
from tms_machine.reasons import NoPlan
from tms_subtasks.records.plans import stored
from tms_subtasks.records.retiming import retimed


class Given(Params):
    """What leaves give beside the records."""

    retime: bool  # an input of the variant: as fast as the machine's limits allow, not as planned
    previous_target_record_name: str = ""  # counts for plans only: tasks of the C++ system give it here, too


class ExecuteFromPlan(Subtask):
    """The record's name is one name or several, comma between. Records without a plan are left out."""

    timeout = 300.0
    params = Given

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        names = [name.strip() for name in record_name.split(",") if name.strip()]
        found = [stored(self.get_param_from_db(model_name, name), name) for name in names]
        plans = [plan for plan in found if plan is not None]
        if not plans:
            raise SubtaskFailed(NoPlan(tuple(names)))
        if self.want.retime:
            plans = [retimed(plan, self.machine.model.joints) for plan in plans]
        self.machine.execute_plans(progress, plans)
