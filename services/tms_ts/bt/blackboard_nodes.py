"""Built-in leaves and the decorators that compare blackboard values."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.convert import MISSING, convert
from tms_ts.bt.decorator import Decorator
from tms_ts.bt.errors import TickError
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.node import AtOnce
from tms_ts.bt.ports import In, InOut, Pointer
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import MissingParameter

EPSILON = 1.1920929e-07  # of a C float


@node
class AlwaysSuccess(SyncAction):
    """Succeed."""

    __slots__ = ()

    def tick(self) -> Status:
        return SUCCESS

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return True, False


@node
class AlwaysFailure(SyncAction):
    """Fail."""

    __slots__ = ()

    def tick(self) -> Status:
        return FAILURE

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return False, True


@node
class SetBlackboard(SyncAction):
    """Store a text, or a copy of another entry, in the blackboard.

    value: the text, or {key} for a copy
    output_key: the name of the key
    """

    __slots__ = ()
    needs = ("value", "output_key")
    key_port = "output_key"
    value: In[Any]
    output_key: InOut[Any]

    def tick(self) -> Status:
        given = self.read("output_key")
        key = MISSING if given is MISSING else convert(given, str)
        if not isinstance(key, str):
            raise TickError(MissingParameter("SetBlackboard", "output_key"))
        source = self.bindings.get("value")
        if source is None:
            raise TickError(MissingParameter("SetBlackboard", "value"))
        if isinstance(source, Pointer) and source.text != "=":
            self.blackboard.copy(source.key, key)
        else:
            self.blackboard.set(key, source.text if isinstance(source, Pointer) else source)
        return SUCCESS

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return True, False


class BlackboardCheck(Decorator):
    """Run the child while two values are equal."""

    __slots__ = ()
    compared_as: ClassVar[Any] = str
    value_A: In[Any]
    value_B: In[Any]
    return_on_mismatch: In[Status] = FAILURE

    def value(self, port: str) -> Any:
        raw = self.read(port)
        return MISSING if raw is MISSING else convert(raw, self.compared_as)

    def equal(self) -> bool:
        a, b = self.value("value_A"), self.value("value_B")
        if a is MISSING or b is MISSING:
            return False
        return bool(abs(a - b) <= EPSILON) if self.compared_as is float else bool(a == b)

    def tick(self) -> Status:
        self.set_state(RUNNING)
        if self.equal():
            return self.child.execute_tick()
        if self.child.state is RUNNING:
            self.child.reset()
        result = self.read("return_on_mismatch")
        return result if isinstance(result, Status) else FAILURE

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        succeeds, fails = children[0]
        result = self.read("return_on_mismatch")
        return succeeds or result is SUCCESS, fails or result not in (SUCCESS, RUNNING)


@node
class BlackboardCheckInt(BlackboardCheck):
    """Run the child while two integers are equal."""

    __slots__ = ()
    compared_as = int


@node
class BlackboardCheckDouble(BlackboardCheck):
    """Run the child while two numbers are equal."""

    __slots__ = ()
    compared_as = float


@node
class BlackboardCheckString(BlackboardCheck):
    """Run the child while two texts are equal."""

    __slots__ = ()
    compared_as = str


@node
class BlackboardCheckBool(BlackboardCheck):
    """Run the child while two truth values are equal."""

    __slots__ = ()
    compared_as = bool
