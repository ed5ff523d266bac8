"""Moves along a plan, and when something has come into the way, along a new one for the rest of the goal.

The goal of the client stays the same, and so do the permits behind it. Each motion is a goal of its own at the gateway,
which lets it pass only while scheduler, subtask and planner stand behind it.
"""

from collections.abc import Callable

from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_ros.goals import Outcome
from tms_ros.server import AnyGoal
from tms_rp.interventions import Interventions
from tms_rp.kind import Moves
from tms_rp.mover import Mover, WayBlocked
from tms_rp.plan import Plan
from tms_rp.reasons import PlannedAnew
from tms_rp.trajectory import Trajectory

TRIES = 3  # times that the rest of a goal is planned anew
PAUSE = 2.0  # s before each: most of what drives by has passed the bucket then

Say = Callable[[Reason, tuple[Reason, ...]], None]  # a progress, and the notes of the plan


class Resuming:
    """Moves one machine.

    `blocked`: what is in the way of a trajectory that runs since so many seconds. `late`: how far [s] the arm is behind
    its trajectory at most.
    """

    def __init__(
        self,
        mover: Mover,
        interventions: Interventions,
        blocked: Callable[[Trajectory, float], Reason | None],
        late: float,
    ) -> None:
        self._mover, self._interventions, self._blocked, self._late = mover, interventions, blocked, late

    def move(self, goal: AnyGoal, plan: Plan, again: Callable[[Moves], Plan], say: Say) -> Outcome:
        """Execute a plan; SUCCEEDED, or CANCELED once the machine has stopped. `again` plans from where the arm is.

        Raises:
            WayBlocked: something is still in the way.
            SubtaskFailed, RosError: as Mover.move; and what somebody did to the machine while the goal waited.
        """
        tries = 0
        while True:
            try:
                return self._try(goal, plan, say)
            except WayBlocked as stop:
                rest, why = plan.rest(stop.seconds - self._late), stop
            found: Plan | None = None
            while found is None:
                if rest is None or tries == TRIES:
                    raise why
                tries += 1
                if not self._waited(goal, why, say):
                    return Outcome.CANCELED
                found = _planned(rest, again)
            plan = found

    def _try(self, goal: AnyGoal, plan: Plan, say: Say) -> Outcome:
        return self._mover.move(
            goal, plan.made, lambda progress: say(progress, plan.notes), lambda at: self._blocked(plan.made, at)
        )

    def _waited(self, goal: AnyGoal, why: WayBlocked, say: Say) -> bool:
        """Wait a while; False after a cancel."""
        self._interventions.forget()
        say(PlannedAnew(why.reason, PAUSE), ())
        if goal.cancelled.wait(PAUSE):
            return False
        if (heard := self._interventions.heard) is not None:
            raise SubtaskFailed(heard)
        return True


def _planned(rest: Moves, again: Callable[[Moves], Plan]) -> Plan | None:
    try:
        return again(rest)
    except SubtaskFailed:
        return None
