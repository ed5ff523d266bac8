"""Whether the server of a goal is still there."""

from typing import Any

import pytest

from tms_ros.client import Peer

OLD, NEW = b"old", b"new"


@pytest.mark.parametrize(
    ("ready", "taken_by", "there", "left"),
    [
        (True, {OLD}, {OLD}, False),
        (True, {OLD}, {OLD, NEW}, False),
        (True, {OLD}, {NEW}, True),  # its successor has the same name, and knows nothing of the goal
        (True, set(), {NEW}, False),  # nobody knows who took it
        (False, {OLD}, {OLD}, True),
    ],
)
def test_a_server_has_left_when_none_that_took_the_goal_is_there(
    ready: bool, taken_by: set[bytes], there: set[bytes], left: bool
) -> None:
    peer: Any = Peer.__new__(Peer)
    peer._taken_by = frozenset(taken_by)
    peer.ready, peer._servers = lambda: ready, lambda: frozenset(there)
    assert peer.left() is left
