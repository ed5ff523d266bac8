"""Leaf node for the machine d37pxi."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.leaf_node import LeafNode


@node
class LeafNodeD37pxi(LeafNode):
    """Let d37pxi do a subtask with the parameters of a record."""

    __slots__ = ()
    versions = (5,)
    model_name: In[str] = "d37pxi"
