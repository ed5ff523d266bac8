"""Answers whether a goal could be carried out, and how: planned as any goal, and nothing moves."""

from collections.abc import Callable

from tms_msg_rp.srv import CheckMotion

from tms_reason.errors import SubtaskFailed, TmsError
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.packing import unpack
from tms_rp import reasons as r
from tms_rp.kind import Angles, PlanningAction
from tms_rp.messages import follow
from tms_rp.plan import Plan
from tms_rp.plans import start_of
from tms_rp.view import Nearest

# Refusals by the goal itself and the machine's own limits; the world has no part in them.
OWN = (
    r.OneTarget, r.AnglesUnfit, r.NamedTwice, r.FieldNotFinite, r.NoOrientation, r.OutOfPlane, r.TooFar, r.TooNear,
    r.TooNearAxis, r.OutOfRange, r.PointOutOfRange, r.NoAngleDigs, r.DigUnfit, r.WouldSpill,
    r.NoTrajectory, r.LimitsLeft,
)  # fmt: skip


class MotionChecks:
    """Checks goals for one machine.

    `names`: joints of the arm; `joints`: their present angles. `plan`: of a goal of an action, from such angles, in the
    scene as it is now. `nearest`: where a plan comes nearest to something.
    """

    def __init__(
        self,
        actions: dict[str, PlanningAction],
        names: tuple[str, ...],
        joints: Callable[[], Angles],
        plan: Callable[[PlanningAction, Angles, object], Plan],
        nearest: Callable[[Plan], Nearest | None],
    ) -> None:
        self._actions, self._names, self._joints, self._plan, self._nearest = actions, names, joints, plan, nearest

    def answer(self, request: CheckMotion.Request, response: CheckMotion.Response) -> CheckMotion.Response:
        """Serve a CheckMotion."""
        response.clearance = float("inf")
        try:
            plan = self._planned(request)
            nearest = self._nearest(plan)
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
            response.lasting = lasting(error.reason)
            return response
        response.plan = follow(plan.made).trajectory
        response.notes = [to_line(note) for note in plan.notes]
        if nearest is not None:
            response.clearance, response.seconds = nearest.distance, nearest.seconds
            response.nearest = to_line(r.Between(nearest.first, nearest.second))
        return response

    def _planned(self, request: CheckMotion.Request) -> Plan:
        action = self._actions.get(request.action)
        if action is None:
            raise SubtaskFailed(r.NoSuchAction(request.action, tuple(self._actions)))
        try:
            goal = unpack(bytes(request.goal), action.type.Goal)
        except RuntimeError:
            raise SubtaskFailed(r.GoalUnreadable(request.action)) from None
        return self._plan(action, start_of(request.previous, self._names) or self._joints(), goal)


def lasting(why: Reason) -> bool:
    """Whether a refusal would be the same in an empty world."""
    if isinstance(why, r.NoWayRound):
        return lasting(why.why)
    if isinstance(why, r.Collision):
        return isinstance(why.first, r.Part) and isinstance(why.second, r.Part)
    return isinstance(why, OWN)
