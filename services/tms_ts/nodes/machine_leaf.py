"""The base of leaves that make a machine do something.

On halt such a leaf asks for the cancel and returns at once: the scheduler goes on watching the goal, whose end confirms
that the machine has stopped.
"""

from __future__ import annotations

import re
from typing import ClassVar

from tms_decision.leaf.state import GoalState
from tms_reason.reason import Reason
from tms_ts.bt.errors import TickError
from tms_ts.bt.leaf import PlainAction
from tms_ts.bt.node import AtOnce, Keys
from tms_ts.bt.ports import In, Pointer
from tms_ts.bt.status import FAILURE, RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import NameMissing, NoMachines, NoRosName, Sending, Working
from tms_ts.world import Goal

OPEN = [state for state in GoalState if not state.final]  # a tick of a thousand nodes asks a hundred times
# Names that ROS accepts: a topic may have 247 letters, including the machine's name and the endings of an action.
ROS_NAME = re.compile(r"(?!.{201})[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*", re.ASCII)


class MachineLeaf(PlainAction):
    """A leaf that sends goals to the action `<model_name>/<what the subtask's port names>`."""

    __slots__ = ("_told", "goal")
    subtask_port: ClassVar[str] = ""
    record_ports: ClassVar[tuple[str, ...]] = ("record_name",)  # the first one that is not empty counts
    model_name: In[str]

    def prepare(self) -> None:
        self.goal: Goal | None = None

    @property
    def reason(self) -> Reason | None:
        """Why it is RUNNING or has failed. An open goal is asked only now: few leaves of a tick are read."""
        if (goal := self.goal) is None:
            return self._told
        return goal.reason or goal.feedback or (Sending() if goal.state is GoalState.SENDING else Working())

    @reason.setter
    def reason(self, why: Reason | None) -> None:
        self._told = why

    def record(self) -> str | None:
        """The record of a goal that begins now, with the goal's inputs; None fails the leaf, whose reason is set."""
        raise NotImplementedError

    def record_reported(self) -> str:
        """The same, as far as the document gives it."""
        raise NotImplementedError

    def goal_asked(self) -> tuple[str, str, str]:
        """Machine, subtask and record, as far as the document gives them."""
        return self.reported("model_name"), self.reported(self.subtask_port), self.record_reported()

    def tick(self) -> Status:
        if (goal := self.goal or self.start()) is None:
            return FAILURE
        state = goal.state
        if state in OPEN:
            return RUNNING
        self.reason, self.goal = goal.reason, None
        return SUCCESS if state is GoalState.SUCCEEDED else FAILURE

    def start(self) -> Goal | None:
        """Send the goal; None without a record, whose reason is set."""
        machine, subtask, record = self.model_name, self.require(self.subtask_port), self.record()
        if not subtask:
            raise TickError(NameMissing(self.registration_name, self.subtask_port))
        if record is None:
            return None
        if self.context.world is None:
            raise TickError(NoMachines(self.registration_name))
        self.goal = self.context.world.machines.send(machine, subtask, record, self.path)
        return self.goal

    def halt(self) -> None:
        goal, self.goal = self.goal, None
        if goal is not None:
            goal.cancel()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return False, False

    def needed(self) -> list[str]:
        bound = [self.bindings.get(port) for port in ("model_name", self.subtask_port, *self.record_ports)]
        return [one.key for one in bound if isinstance(one, Pointer)]

    def faults(self) -> list[Reason]:
        empty = self.literal(self.subtask_port) == ""
        return [NameMissing(self.registration_name, self.subtask_port)] if empty else []

    def preflight(self, keys: Keys) -> list[Reason]:
        names = {port: self.literal(port) or "" for port in ("model_name", self.subtask_port)}
        return [NoRosName(port, name) for port, name in names.items() if name and not ROS_NAME.fullmatch(name)]
