"""Store a typed value in the local blackboard."""

from __future__ import annotations

import re
from typing import Any

from tms_ts.bt.convert import MISSING, kind_of
from tms_ts.bt.errors import TickError
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.ports import In, InOut, Pointer
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.tree_reasons import MissingParameter


def typed(text: str) -> str | bool | int | float:
    """The value that a text stands for: a bool, an integer, a real number, or the text."""
    if text in ("true", "false"):
        return text == "true"
    if re.fullmatch(r"-?[0-9]{1,18}", text):
        return int(text)
    return float(text) if re.fullmatch(r"-?[0-9]+\.[0-9]+", text) else text


@node
class SetLocalBlackboard(SyncAction):
    """Store a value with its type: true and false, whole numbers, decimal numbers, else a text.

    value: the value
    output_key: the name of the key
    """

    __slots__ = ()
    versions = (5, 6)
    value: In[Any]
    output_key: InOut[Any]

    def tick(self) -> Status:
        value, key = self.read("value"), self.key_name()
        if value is MISSING:
            raise TickError(MissingParameter("SetLocalBlackboard", "value"))
        self.store(key, typed(value) if isinstance(value, str) else value)
        return SUCCESS

    def written(self) -> list[tuple[str, Any]]:
        value, bound = self.literal("value"), self.bindings.get("output_key")
        return [] if value is None or bound is None else [(self.key_name(), kind_of(typed(value)))]

    def key_name(self) -> str:
        bound = self.bindings.get("output_key")
        if bound is None:
            raise TickError(MissingParameter("SetLocalBlackboard", "output_key"))
        return bound.key if isinstance(bound, Pointer) else bound
