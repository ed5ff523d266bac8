"""Decide by an expression over blackboard values."""

from __future__ import annotations

from typing import ClassVar

from tms_reason.reason import Reason
from tms_ts.bt.convert import MISSING
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status
from tms_ts.nodes.expression import TRUTH, Invalid, Scalar, beside_numbers, evaluate, names
from tms_ts.tree_reasons import AlwaysFails, NoExpression, NumberBesideText, NumberTooBig, StoredTextFails


class Deciding(SyncAction):
    """A node that evaluates a condition."""

    __slots__ = ()
    text_port: ClassVar[str] = ""

    def lookup(self, key: str) -> Scalar:
        value = self.blackboard.get(key)
        if isinstance(value, int) and not -(2**31) <= value < 2**31:
            self.warn(NumberTooBig(key))
        return "" if value is MISSING else value

    def tick(self) -> Status:
        text = self.read(self.text_port)
        try:
            if not isinstance(text, str):
                raise Invalid(NoExpression())
            return SUCCESS if evaluate(text, self.lookup, self.warn) else FAILURE
        except Invalid as error:
            self.reason = error.why
            return FAILURE

    def preflight(self, keys: Keys) -> list[Reason]:
        text = self.literal(self.text_port)
        if text is None:
            return []
        try:
            read, numbers = names(text), beside_numbers(text)
        except Invalid as error:
            return [AlwaysFails(error.why, self.registration_name)]
        texts = keys.texts
        return [
            *(StoredTextFails(texts[key], key) for key in sorted(read & texts.keys()) if texts[key] in TRUTH),
            *(NumberBesideText(key, value) for key, value in numbers.items() if self.number_written(keys, key)),
        ]


@node
class ConditionalExpression(Deciding):
    """Succeed while an expression over blackboard keys is true; fail if it is false or cannot be evaluated.

    conditional_expression: e.g. (ARRIVAL_FLG == true or LOADED_FLG == true) and CURRENT_LOCATION == 2 and UP == "up"
    """

    __slots__ = ()
    versions = (5, 6)
    text_port = "conditional_expression"
    needs = ("conditional_expression",)
    conditional_expression: In[str]
