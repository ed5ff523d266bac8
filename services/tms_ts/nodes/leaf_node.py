"""The leaf that makes a machine do a subtask; each machine model has a subclass, with its name and its ports.

On halt it asks for the cancel and returns at once: the scheduler goes on watching the goal, whose end confirms that the
machine has stopped.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from tms_decision.leaf.state import GoalState
from tms_reason.reason import Reason
from tms_ts.bt.errors import TickError
from tms_ts.bt.leaf import PlainAction
from tms_ts.bt.node import AtOnce
from tms_ts.bt.ports import In
from tms_ts.bt.reasons import NoMachines, NoRosName, Sending, Working
from tms_ts.bt.registry import generic
from tms_ts.bt.status import FAILURE, RUNNING, SUCCESS, Status
from tms_ts.world import Goal

# Names that ROS accepts: a topic may have 247 letters, including the machine's name and the endings of an action.
ROS_NAME = re.compile(r"(?!.{201})[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*", re.ASCII)


@generic
class LeafNode(PlainAction):
    """Let a machine do a subtask with the parameters of a record.

    model_name: the machine, e.g. zx200
    record_name: the record of parameters, as text or {key}
    subtask_name: the subtask, e.g. st_zx200_follow_waypoints
    """

    __slots__ = ("goal",)
    required = frozenset({"model_name", "subtask_name"})
    needs = ("record_name",)
    model_name: In[str]
    record_name: In[str]
    subtask_name: In[str]

    def prepare(self) -> None:
        self.goal: Goal | None = None

    def goal_asked(self) -> tuple[str, str, str]:
        """Machine, subtask and record, as far as the document gives them."""
        return self.reported("model_name"), self.reported("subtask_name"), self.reported("record_name")

    def tick(self) -> Status:
        return self.start() if self.goal is None else self.progress(self.goal)

    def start(self) -> Status:
        machine, subtask, record = self.model_name, self.subtask_name, self.record_name
        if self.context.world is None:
            raise TickError(NoMachines(self.registration_name))
        self.goal = self.context.world.machines.send(machine, subtask, record, self.path)
        return self.progress(self.goal)

    def progress(self, goal: Goal) -> Status:
        state = goal.state
        if not state.final:
            self.reason = goal.reason or goal.feedback or (Working() if state is GoalState.RUNNING else Sending())
            return RUNNING
        self.reason = goal.reason
        self.goal = None
        return SUCCESS if state is GoalState.SUCCEEDED else FAILURE

    def halt(self) -> None:
        goal, self.goal = self.goal, None
        if goal is not None:
            goal.cancel()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return False, False

    def preflight(self, texts: Mapping[str, str]) -> list[Reason]:
        names = {port: self.literal(port) or "" for port in ("model_name", "subtask_name")}
        return [NoRosName(port, name) for port, name in names.items() if name and not ROS_NAME.fullmatch(name)]
