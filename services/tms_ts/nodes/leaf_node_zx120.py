"""Leaf node for the machine zx120."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.leaf_node import LeafNode


@node
class LeafNodeZx120(LeafNode):
    """Let zx120 do a subtask with the parameters of a record."""

    __slots__ = ()
    model_name: In[str] = "zx120"
