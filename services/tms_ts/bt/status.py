"""Status and kind of a node; the numbers are those that Groot expects on the wire."""

from __future__ import annotations

from enum import IntEnum

from py_trees.common import Status as PyTreesStatus


class Status(IntEnum):
    """What a tick returns, with the numbers of Groot."""

    IDLE = 0
    RUNNING = 1
    SUCCESS = 2
    FAILURE = 3

    @property
    def completed(self) -> bool:
        return self >= 2


class NodeType(IntEnum):
    """What a node is in Groot, with its numbers."""

    UNDEFINED = 0
    ACTION = 1
    CONDITION = 2
    CONTROL = 3
    DECORATOR = 4
    SUBTREE = 5


IDLE, RUNNING, SUCCESS, FAILURE = Status.IDLE, Status.RUNNING, Status.SUCCESS, Status.FAILURE

PY_TREES = {
    IDLE: PyTreesStatus.INVALID,
    RUNNING: PyTreesStatus.RUNNING,
    SUCCESS: PyTreesStatus.SUCCESS,
    FAILURE: PyTreesStatus.FAILURE,
}
FROM_PY_TREES = {theirs: ours for ours, theirs in PY_TREES.items()}
