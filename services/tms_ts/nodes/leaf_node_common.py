"""Leaf node for machines of any kind."""

from tms_ts.bt.registry import node
from tms_ts.nodes.primitive_leaf import PrimitiveLeaf


@node
class LeafNodeCommon(PrimitiveLeaf):
    """Let any machine do a primitive with the parameters of a record; fail if the record is not given."""

    __slots__ = ()
