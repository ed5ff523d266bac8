"""Control nodes that choose among their children: IfThenElse, WhileDoElse and Switch2 to Switch6."""

from __future__ import annotations

from typing import ClassVar

from tms_reason.reason import Reason
from tms_ts.bt.control import Control
from tms_ts.bt.convert import MISSING
from tms_ts.bt.errors import TickError
from tms_ts.bt.node import AtOnce
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import IfThenElseChildren, SwitchChildren, WhileDoElseChildren


def chosen_synchronously(children: list[AtOnce]) -> AtOnce:
    """Whether the node may succeed and may fail within one tick; its first child, a condition, may also end it."""
    return any(succeeds for succeeds, _ in children[1:]), any(fails for _, fails in children[1:])


@node
class IfThenElse(Control):
    """Ask the first child once, then run the second (success) or third child to its end."""

    __slots__ = ("chosen",)

    def prepare(self) -> None:
        self.chosen = 0  # 0: the condition is not answered yet

    def tick(self) -> Status:
        count = len(self.children)
        if count not in (2, 3):
            raise TickError(IfThenElseChildren(count))
        self.set_state(RUNNING)
        if self.chosen == 0:
            status = self.children[0].execute_tick()
            if status is RUNNING:
                return RUNNING
            if status is IDLE:
                raise self.never_idle(self.children[0])
            if status is FAILURE and count == 2:
                return FAILURE  # the condition keeps its FAILURE, as in the library
            self.chosen = 1 if status is SUCCESS else 2
        status = self.children[self.chosen].execute_tick()
        if status is not RUNNING:
            self.reset_children()
            self.chosen = 0
        return status

    def halt(self) -> None:
        self.chosen = 0
        self.reset_children()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        if not children or not any(children[0]):
            return False, False
        succeeds, fails = chosen_synchronously(children)
        return succeeds, fails or (len(children) == 2 and children[0][1])

    def faults(self) -> list[Reason]:
        count = len(self.children)
        return [] if count in (2, 3) else [IfThenElseChildren(count)]


@node
class WhileDoElse(Control):
    """Ask the first child at every tick; run the second while it succeeds, the third while it fails."""

    __slots__ = ()

    def tick(self) -> Status:
        if len(self.children) != 3:
            raise TickError(WhileDoElseChildren(len(self.children)))
        self.set_state(RUNNING)
        condition, do, otherwise = self.children
        status = condition.execute_tick()
        if status is RUNNING:
            return RUNNING
        if status is SUCCESS:
            otherwise.reset()
            status = do.execute_tick()
        elif status is FAILURE:
            do.reset()
            status = otherwise.execute_tick()
        if status is not RUNNING:
            self.reset_children()
        return status

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return chosen_synchronously(children) if children and any(children[0]) else (False, False)

    def faults(self) -> list[Reason]:
        count = len(self.children)
        return [] if count == 3 else [WhileDoElseChildren(count)]


class Switch(Control):
    """Tick the child whose case text equals the variable, else the last child."""

    __slots__ = ("running",)
    cases: ClassVar[int] = 0
    variable: In[str]

    def prepare(self) -> None:
        self.running = -1

    def match(self) -> int:
        value = self.read("variable")
        if value is not MISSING:
            for case in range(self.cases):
                if self.read(f"case_{case + 1}") == value:
                    return case
        return self.cases

    def tick(self) -> Status:
        if len(self.children) != self.cases + 1:
            raise TickError(SwitchChildren(self.registration_name, self.cases + 1, len(self.children)))
        match = self.match()
        if self.running not in (-1, match):
            self.children[self.running].reset()
        status = self.children[match].execute_tick()
        if status is RUNNING:
            self.running = match
        else:
            self.reset_children()
            self.running = -1
        return status

    def halt(self) -> None:
        self.running = -1
        self.reset_children()

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return any(succeeds for succeeds, _ in children), any(fails for _, fails in children)

    def faults(self) -> list[Reason]:
        count, wanted = len(self.children), self.cases + 1
        return [] if count == wanted else [SwitchChildren(self.registration_name, wanted, count)]


@node
class Switch2(Switch):
    """Choose among 2 cases and a default."""

    __slots__ = ()
    cases = 2
    case_1: In[str]
    case_2: In[str]


@node
class Switch3(Switch2):
    """Choose among 3 cases and a default."""

    __slots__ = ()
    cases = 3
    case_3: In[str]


@node
class Switch4(Switch3):
    """Choose among 4 cases and a default."""

    __slots__ = ()
    cases = 4
    case_4: In[str]


@node
class Switch5(Switch4):
    """Choose among 5 cases and a default."""

    __slots__ = ()
    cases = 5
    case_5: In[str]


@node
class Switch6(Switch5):
    """Choose among 6 cases and a default."""

    __slots__ = ()
    cases = 6
    case_6: In[str]
