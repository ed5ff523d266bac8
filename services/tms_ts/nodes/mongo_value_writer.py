"""Write one field of a shared record."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_reason.reason import Reason
from tms_ts.bt.convert import Missing
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.nodes.asking import Asking
from tms_ts.nodes.shared_value import hopeless, keys_named, surprising, written
from tms_ts.tree_reasons import AlwaysFails
from tms_ts.world import Pending


@node
class MongoValueWriter(Asking):
    r"""Write a value to a field of a record; fail if the record is not there.

    mongo_record_name: the record
    mongo_param_name: the field
    input_value: true, false, a number, a text, a "text" in quotes, or the value of a \key\
    input_type: (version 6) int, double, bool or string, whatever the value looks like
    """

    __slots__ = ()
    versions = (5, 6)
    writes: ClassVar[bool] = True
    mongo_record_name: In[str]
    mongo_param_name: In[str]
    input_value: In[str]
    input_type: In[str]

    def record_asked(self) -> tuple[str, str]:
        return self.reported("mongo_record_name"), self.reported("mongo_param_name")

    def ask(self) -> Pending[Any] | None:
        value = written(self, self.input_value, self.read("input_type") or "")
        if isinstance(value, Missing):
            return None
        return self.world.flags.write(self.mongo_record_name, self.mongo_param_name, value)

    def answered(self, value: Any) -> Status:
        return SUCCESS

    def needed(self) -> list[str]:
        return keys_named(self.literal("input_value"))

    def preflight(self, keys: Keys) -> list[Reason]:
        text, type_ = self.literal("input_value"), self.literal("input_type") or ""
        if text is None:
            return []
        if (why := hopeless(self, text, type_)) is not None:
            return [AlwaysFails(why, self.registration_name)]
        note = None if type_ or "input_type" in self.bindings else surprising(text)
        return [] if note is None else [note]
