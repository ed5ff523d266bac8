"""What a planner has found: a checked trajectory, and the goal that it serves."""

from dataclasses import dataclass

from tms_reason.reason import Reason
from tms_rp.kind import Moves
from tms_rp.trajectory import Trajectory


@dataclass(frozen=True)
class Plan:
    """A checked trajectory, what people should know of it, and the goal that it serves.

    `reached`: when [s] the trajectory is at each target of `moves`; empty for stored plans. A way around may end whole
    turns away from the target that the goal has asked for; the targets here are those that it goes to.
    """

    made: Trajectory
    notes: tuple[Reason, ...]
    moves: Moves
    reached: tuple[float, ...] = ()

    def rest(self, seconds: float) -> Moves | None:
        """What is left of the goal so many seconds after the begin; None for stored plans, which are kept as they are.

        It ends in the last target, also when the arm was there already: it may have been stopped a little before.
        """
        if not self.reached:
            return None
        return self.moves.rest(max(1, sum(at > seconds for at in self.reached)))
