"""Leaf node for the assistance of excavators."""

from tms_ts.bt.registry import node
from tms_ts.nodes.primitive_leaf import PrimitiveLeaf


@node
class LeafNodeExcavatorAssist(PrimitiveLeaf):
    """Let an excavator do a primitive that assists its operator; fail if the record is not given."""

    __slots__ = ()
