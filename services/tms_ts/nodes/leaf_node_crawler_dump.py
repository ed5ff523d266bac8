"""Leaf node for crawler dumps."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.primitive_leaf import PrimitiveLeaf


@node
class LeafNodeCrawlerDump(PrimitiveLeaf):
    """Let a crawler dump do a primitive with the parameters of a record; fail if the record is not given.

    read_direction: down: the places of the record from the last to the first; else from the first to the last
    """

    __slots__ = ()
    read_direction: In[str]
