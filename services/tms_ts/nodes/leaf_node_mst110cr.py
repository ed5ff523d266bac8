"""Leaf node for the machine mst110cr."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.leaf_node import LeafNode


@node
class LeafNodeMst110cr(LeafNode):
    """Let mst110cr do a subtask with the parameters of a record."""

    __slots__ = ()
    versions = (5,)
    model_name: In[str] = "mst110cr"
