"""Read one field of a shared record into the local blackboard."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status
from tms_ts.nodes.asking import Asking
from tms_ts.tree_reasons import NotPlain
from tms_ts.world import Pending


@node
class BlackboardValueReaderMongo(Asking):
    """Copy a field of a record to the blackboard; fail if it is not there or is not a plain value.

    mongo_record_name: the record
    mongo_param_name: the field
    output_port: the key to write
    """

    __slots__ = ()
    versions = (5,)
    key_port = "output_port"
    writes: ClassVar[bool] = False
    mongo_record_name: In[str]
    mongo_param_name: In[str]
    output_port: In[str]

    def record_asked(self) -> tuple[str, str]:
        return self.reported("mongo_record_name"), self.reported("mongo_param_name")

    def ask(self) -> Pending[Any]:
        return self.world.flags.read(self.mongo_record_name, self.mongo_param_name)

    def answered(self, value: Any) -> Status:
        if not isinstance(value, str | bool | int | float):
            self.reason = NotPlain(self.mongo_record_name, self.mongo_param_name)
            return FAILURE
        self.store(self.output_port, value)
        return SUCCESS
