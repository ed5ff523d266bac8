"""Goals that come from no run of ours: whether their sender is understood, and whether it can still cancel them."""

from tms_config.config import Site
from tms_decision.owner import parse
from tms_machine.leaf_forms import misfit
from tms_machine.permit import RemotePermit
from tms_machine.reasons import BorderLost
from tms_reason.reason import Reason
from tms_ros.server import AnyGoal
from tms_runtime.app import App


class ForeignGoals:
    """The foreign goals of one subtask.

    With peers of version 6 they come through `<machine>:if`, which alone can bring a cancel: with it the goal ends.
    Else the peer's own form is checked. rclpy does not tell which client has sent a goal, so a client that would be
    misunderstood refuses the goals of all foreign ones.
    """

    def __init__(self, app: App) -> None:
        self._app, self._subtask = app, str(app.process.action)
        self._site: Site = app.site
        self._border: RemotePermit | None = None  # made with the first foreign goal: it wakes the process
        self._goal: AnyGoal | None = None

    def refusal(self, goal: AnyGoal) -> Reason | None:
        """Why a goal is not begun; None for every goal of a run."""
        if parse(goal.uuid) is not None or self._site.other_form(self._app.machine):
            return None
        return misfit(self._app.ros, self._site, self._app.machine, self._subtask, servers=False)

    def watch(self, goal: AnyGoal | None) -> None:
        """Cancel this goal when the border that has passed it on is lost; None: there is no goal any more."""
        foreign = goal is not None and parse(goal.uuid) is None and bool(self._site.other_form(self._app.machine))
        self._goal = goal if foreign else None
        if foreign and self._border is None:
            self._border = RemotePermit(
                self._app.ros, self._app.pulse, self._app.machine, f"if_{self._subtask}", self._changed
            )

    def _changed(self, border: RemotePermit) -> None:
        goal = self._goal
        if goal is not None and border.lost(goal.uuid):
            self._app.log.warning("cancelled", goal=goal.id, reason=BorderLost(f"{self._app.machine}:if"))
            goal.cancel()
