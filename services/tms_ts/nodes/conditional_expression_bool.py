"""Decide by an expression over boolean blackboard values; kept for older trees."""

from __future__ import annotations

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.conditional_expression import Deciding
from tms_ts.nodes.expression import TRUTH, Invalid, Scalar
from tms_ts.tree_reasons import KeyIsNumber, NotBooleanKey, TextCountsAsBoolean


@node
class ConditionalExpressionBool(Deciding):
    """Succeed while an expression over boolean blackboard keys is true; other keys are unknown to it.

    conditional_expression_bool: e.g. CONTINUE_FLG == true
    """

    __slots__ = ()
    text_port = "conditional_expression_bool"
    needs = ("conditional_expression_bool",)
    conditional_expression_bool: In[str]

    def lookup(self, key: str) -> Scalar:
        value = self.blackboard.get(key)
        if isinstance(value, bool):
            return value
        if isinstance(value, int | float):
            self.warn(KeyIsNumber(key, self.registration_name))
            return value
        if isinstance(value, str) and value in TRUTH:
            self.warn(TextCountsAsBoolean(value, key))
            return TRUTH[value]
        raise Invalid(NotBooleanKey(key))
