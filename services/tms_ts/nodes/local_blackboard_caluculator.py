"""Calculate with blackboard values. The name is spelled as in the C++ system."""

from __future__ import annotations

from tms_reason.reason import Reason
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In, Pointer
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status
from tms_ts.nodes.calculation import calculate, keys_of, parse
from tms_ts.nodes.expression import WHOLE_NUMBER, Invalid
from tms_ts.tree_reasons import AllBraces, AlwaysFails, HoldsNoNumber


@node
class LocalBlackboardCaluculator(SyncAction):
    """Store the result of a formula as a decimal number; fail if it has none.

    calculation_formula: numbers, keys in braces, + - * / and parentheses, e.g. ({count} + 1) * 2.5
    output_key: the key to write
    """

    __slots__ = ()
    versions = (6,)
    needs = ("calculation_formula", "output_key")
    key_port, key_kind = "output_key", float
    calculation_formula: In[str]
    output_key: In[str]

    def formula(self) -> str:
        """The formula: that of a key, or the port's own, also if it begins and ends with a brace as {a} + {b} does."""
        bound = self.bindings.get("calculation_formula")
        stored = self.blackboard.get(bound.key) if isinstance(bound, Pointer) else None
        if isinstance(stored, str):
            return stored
        return bound.text if isinstance(bound, Pointer) else str(self.calculation_formula)

    def number(self, key: str) -> float:
        """The number at a key; a counter keeps it as text."""
        value = self.blackboard.get(key)
        if isinstance(value, str) and WHOLE_NUMBER.fullmatch(value):
            return float(value)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise Invalid(HoldsNoNumber(key))
        return float(value)

    def tick(self) -> Status:
        try:
            result = calculate(self.formula(), self.number)
        except Invalid as error:
            self.reason = error.why
            return FAILURE
        self.store(self.output_key, result)
        return SUCCESS

    def needed(self) -> list[str]:
        bound = self.bindings.get("calculation_formula")
        return keys_of(bound.text if isinstance(bound, Pointer) else bound or "")

    def preflight(self, keys: Keys) -> list[Reason]:
        bound = self.bindings.get("calculation_formula")
        if isinstance(bound, Pointer) and "{" in bound.key:
            return [AllBraces("calculation_formula", bound.text)]
        try:
            parse("0" if bound is None or isinstance(bound, Pointer) else bound)
        except Invalid as error:
            return [AlwaysFails(error.why, self.registration_name)]
        return []
