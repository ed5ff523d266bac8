"""`tms_rp_excavator`: our planner under the name and type that primitives of the C++ system's version 6 call.

Its goals become goals of our own actions: a plan moves nothing, and what is executed is checked like every stored plan
and passes the gateway. The process has TmsRpExcavator in the form of the site file (tms_runtime/wire_form.py).
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from tms_msg_rp.action import ExecutePlans, TmsRpExcavator
from trajectory_msgs.msg import JointTrajectory

from tms_machine.peer_forms import misfit
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_rp.excavator_messages import leaves, not_kept, plan_goal, progress_of, stored_plans
from tms_rp.excavator_settings import Settings
from tms_rp.kind import PlanningAction
from tms_rp.messages import follow
from tms_rp.plan import Plan
from tms_rp.reasons import NothingToExecute, UnknownCommand
from tms_runtime.app import App

ACTION = "tms_rp_excavator"
SUCCESS, FAILURE, PREEMPTED = 1, 99999, -7  # of moveit_msgs/MoveItErrorCodes
Say = Callable[[Reason], None]
CarryOut = Callable[[PlanningAction, AnyGoal, Any, Say], tuple[Outcome, Plan | None]]


class ExcavatorServer:
    """Serves one excavator's planner.

    `plan`, `execute`: the planner's actions PlanPose and ExecutePlans. `reserve` takes the machine for a goal that
    moves it, or tells why not; `carry_out` does a goal. `settings`: how the planner is set now.
    """

    def __init__(
        self, app: App, plan: PlanningAction, execute: PlanningAction,
        reserve: Callable[[PlanningAction], Reason | None], carry_out: CarryOut, settings: Callable[[], Settings],
    ) -> None:  # fmt: skip
        self._plan, self._execute, self._reserve, self._carry_out = plan, execute, reserve, carry_out
        self._settings = settings
        form = str(app.site.file.forms.TmsRpExcavator)
        self._misfit = partial(misfit, app.ros, app.machine, ACTION, "TmsRpExcavator", form, servers=False)
        app.ros.serve(TmsRpExcavator, f"/{app.machine}/{ACTION}", self.run, self.accept)

    def accept(self, request: Any) -> Reason | None:
        """Why a goal is refused."""
        if (why := self._misfit()) is not None:
            return why
        if request.command == request.CMD_EXECUTE_PLAN:
            return self._reserve(self._execute) if stored_plans(request) else NothingToExecute()
        planned = request.command in (request.CMD_PLAN_TO_POSE, request.CMD_PLAN_TO_JOINTS)
        return not_kept(request.constraints) if planned else UnknownCommand(request.command)

    def run(self, goal: AnyGoal) -> Ended[Any]:
        """Do a goal."""
        request, last = goal.request, list[Reason]()

        def say(state: Reason) -> None:
            last[:] = [state]
            goal.publish(TmsRpExcavator.Feedback(state=to_line(state), progress=progress_of(state)))

        executes = request.command == request.CMD_EXECUTE_PLAN
        if executes:
            wanted: Any = ExecutePlans.Goal(plans=stored_plans(request))
            outcome, plan = self._carry_out(self._execute, goal, wanted, say)
        else:
            outcome, plan = self._carry_out(self._plan, goal, plan_goal(request, self._settings()), say)
        path = None if plan is None else follow(plan.made).trajectory
        if path is not None and not executes and (why := leaves(request.constraints, path)) is not None:
            outcome = Outcome.ABORTED
            say(why)
        return outcome, self._result(outcome, path, last)

    def _result(self, outcome: Outcome, path: JointTrajectory | None, last: list[Reason]) -> TmsRpExcavator.Result:
        codes = {Outcome.SUCCEEDED: SUCCESS, Outcome.CANCELED: PREEMPTED}
        result = TmsRpExcavator.Result(
            success=outcome is Outcome.SUCCEEDED, moveit_error_code=codes.get(outcome, FAILURE),
            message=" ".join(map(to_line, last)),
        )  # fmt: skip
        if outcome is Outcome.SUCCEEDED and path is not None:
            result.plan.joint_trajectory = path
        return result
