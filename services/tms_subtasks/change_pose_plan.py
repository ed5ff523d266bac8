"""Plan a motion of the arm to the waypoint of a record, and store the plan there; nothing moves."""

from tms_kit.subtask import Progress, Subtask
from tms_subtasks.records.plans import document, stored
from tms_subtasks.records.waypoints import Waypoint


class ChangePosePlan(Subtask):
    """The plan begins at the end of the plan before it, if the leaf names one, else where the arm is now."""

    timeout = 60.0
    params = Waypoint

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        want: Waypoint = self.want
        machine, before = self.machine, want.previous_target_record_name
        previous = stored(self.get_param_from_db(model_name, before), before) if before else None
        goal = want.goal(previous, machine.angle_of)
        scales = want.velocity_scale, want.acceleration_scale
        plan = machine.plan_pose(progress, goal, previous, *scales, group=want.planning_group)
        want.constraints.check(plan, previous, machine.angle_of)
        self.set_param_in_db(model_name, record_name, {"plan": document(plan)})
