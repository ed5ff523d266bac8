"""Leaf node for the machine mst2200."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.leaf_node import LeafNode


@node
class LeafNodeMst2200(LeafNode):
    """Let mst2200 do a subtask with the parameters of a record."""

    __slots__ = ()
    versions = (5,)
    model_name: In[str] = "mst2200"
