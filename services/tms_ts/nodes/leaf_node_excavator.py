"""Leaf node for excavators, with the ports of the newest version 6 and of its older tasks."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.primitive_leaf import PrimitiveLeaf


@node
class LeafNodeExcavator(PrimitiveLeaf):
    """Let an excavator do a primitive with the parameters of a record; fail if the record is not given.

    target_record_name: the record of parameters, as text or {key}
    previous_target_record_name: the record whose plan ends where this one begins; empty: none
    record_name: the record, in older tasks of version 6, which its newest state does not load
    """

    __slots__ = ()
    older_ports = frozenset({"record_name"})
    record_ports = ("target_record_name", "record_name")
    target_record_name: In[str]
    previous_target_record_name: In[str]
