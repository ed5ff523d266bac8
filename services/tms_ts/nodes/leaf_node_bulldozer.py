"""Leaf node for bulldozers."""

from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.nodes.primitive_leaf import PrimitiveLeaf


@node
class LeafNodeBulldozer(PrimitiveLeaf):
    """Let a bulldozer do a primitive with the parameters of a record; fail if the record is not given.

    blade_hold: whether the blade is held after the end, until the next goal
    """

    __slots__ = ()
    blade_hold: In[bool]
