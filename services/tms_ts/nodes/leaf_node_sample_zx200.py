"""Leaf node for the sample subtasks of zx200."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.leaf_node import LeafNode


@node
class LeafNodeSampleZx200(LeafNode):
    """Let zx200 do a subtask with the parameters of a record."""

    __slots__ = ()
    model_name: In[str] = "zx200"
