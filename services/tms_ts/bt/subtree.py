"""SubTree and SubTreePlus: another tree of the document as one node."""

from __future__ import annotations

from typing import ClassVar

from tms_ts.bt.decorator import Decorator
from tms_ts.bt.registry import node
from tms_ts.bt.status import IDLE, RUNNING, NodeType, Status


@node
class SubTree(Decorator):
    """Run another tree on its own blackboard; attributes map its keys to keys of this tree."""

    __slots__ = ()
    kind: ClassVar[NodeType] = NodeType.SUBTREE

    def tick(self) -> Status:
        if self.state is IDLE:
            self.set_state(RUNNING)
        status = self.child.execute_tick()
        if status is not RUNNING:
            self.child.reset()
        return status


@node
class SubTreePlus(SubTree):
    """Run another tree; attributes map keys with {braces} or give constants."""

    __slots__ = ()
