"""Take a lock, or change a shared value only if it still is what the task believes."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.nodes.asking import Asking
from tms_ts.nodes.shared_value import typed
from tms_ts.world import Pending


@node
class MongoValueSwap(Asking):
    """Write a value to a field of a record if the field holds the expected value; fail if it holds another one.

    Of several tasks that swap at the same time one succeeds: a road section is locked by swapping false for true.
    A run that is resumed comes here again and would wait for its own lock. Let the field hold who has it, a text like
    free or zx200, and take the lock in a Fallback of two swaps: free for zx200, then zx200 for zx200.

    mongo_record_name: the record
    mongo_param_name: the field
    expected_value: what the field must hold: true, false, a number or a text
    input_value: what is written then
    """

    __slots__ = ()
    writes: ClassVar[bool] = True
    mongo_record_name: In[str]
    mongo_param_name: In[str]
    expected_value: In[str]
    input_value: In[str]

    def record_asked(self) -> tuple[str, str]:
        return self.reported("mongo_record_name"), self.reported("mongo_param_name")

    def ask(self) -> Pending[Any]:
        expected, value = typed(self.expected_value), typed(self.input_value)
        return self.world.flags.write(self.mongo_record_name, self.mongo_param_name, value, expected)

    def answered(self, value: Any) -> Status:
        return SUCCESS
