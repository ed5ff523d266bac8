"""Write one field of a shared record."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.convert import MISSING, Missing, text_to_double, text_to_int, text_to_integer
from tms_ts.bt.ports import In
from tms_ts.bt.reasons import TextIsNoNumber
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.nodes.asking import Asking
from tms_ts.world import Pending, Value

ANY_INTEGER = 10**400


def typed(text: str) -> Value | Missing:
    """The value that a text stands for: a bool, a number by its beginning ("3_FLG" is 3), or itself."""
    if text in ("true", "false"):
        return text == "true"
    if "." in text:
        return text_to_double(text)
    if text_to_integer(text, -ANY_INTEGER, ANY_INTEGER) is MISSING:
        return text
    return text_to_int(text)


@node
class MongoValueWriter(Asking):
    """Write a value to a field of a record; fail if the record is not there.

    mongo_record_name: the record
    mongo_param_name: the field
    input_value: true, false, a number or a text
    """

    __slots__ = ()
    writes: ClassVar[bool] = True
    mongo_record_name: In[str]
    mongo_param_name: In[str]
    input_value: In[str]

    def record_asked(self) -> tuple[str, str]:
        return self.reported("mongo_record_name"), self.reported("mongo_param_name")

    def ask(self) -> Pending[Any] | None:
        value = typed(self.input_value)
        if isinstance(value, Missing):
            self.reason = TextIsNoNumber(self.input_value)
            return None
        return self.world.flags.write(self.mongo_record_name, self.mongo_param_name, value)

    def answered(self, value: Any) -> Status:
        return SUCCESS
