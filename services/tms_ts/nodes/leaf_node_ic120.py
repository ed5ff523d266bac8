"""Leaf node for the machine ic120."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.leaf_node import LeafNode


@node
class LeafNodeIc120(LeafNode):
    """Let ic120 do a subtask with the parameters of a record."""

    __slots__ = ()
    versions = (5,)
    model_name: In[str] = "ic120"
