"""Read one field of a shared record into the local blackboard; the name of that node since version 6."""

from __future__ import annotations

from tms_ts.bt.registry import node
from tms_ts.nodes.blackboard_value_reader_mongo import BlackboardValueReaderMongo


@node
class MongoValueReader(BlackboardValueReaderMongo):
    """Copy a field of a record to the blackboard; fail if it is not there or is not a plain value."""

    __slots__ = ()
    versions = (6,)
