"""Change an array in a shared record."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_reason.reason import Reason
from tms_ts.bt.convert import Missing
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.nodes.asking import Asking
from tms_ts.nodes.shared_value import keys_named, surprising, written
from tms_ts.tree_reasons import AlwaysFails, NoOperation
from tms_ts.world import ARRAY_CHANGES, Pending


@node
class MongoArrayWriter(Asking):
    r"""Change an array in a field of a record; fail if the record is not there or the field is no array.

    mongo_record_name: the record
    mongo_param_name: the field; add and push make it if it is missing
    input_value: true, false, a number, a text, a "text" in quotes, or the value of a \key\; reset ignores it
    operation: add (unless it is in the array), push (at its end), remove (wherever it is), or reset (to an empty array)
    """

    __slots__ = ()
    versions = (6,)
    needs = ("mongo_record_name", "mongo_param_name", "operation")
    writes: ClassVar[bool] = True
    mongo_record_name: In[str]
    mongo_param_name: In[str]
    input_value: In[str]
    operation: In[str]

    def record_asked(self) -> tuple[str, str]:
        return self.reported("mongo_record_name"), self.reported("mongo_param_name")

    def ask(self) -> Pending[Any] | None:
        operation = self.operation
        if operation not in ARRAY_CHANGES:
            self.reason = NoOperation(operation)
            return None
        value = "" if operation == "reset" else written(self, self.input_value, "")
        if isinstance(value, Missing):
            return None
        return self.world.flags.change_array(self.mongo_record_name, self.mongo_param_name, operation, value)

    def answered(self, value: Any) -> Status:
        return SUCCESS

    def needed(self) -> list[str]:
        return keys_named(self.literal("input_value"))

    def preflight(self, keys: Keys) -> list[Reason]:
        operation, text = self.literal("operation"), self.literal("input_value")
        if operation is not None and operation not in ARRAY_CHANGES:
            return [AlwaysFails(NoOperation(operation), self.registration_name)]
        note = None if text is None or operation == "reset" else surprising(text)
        return [] if note is None else [note]
