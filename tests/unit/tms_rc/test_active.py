"""What a goal lets expect of a machine that is stopped now."""

from typing import Any

import pytest

from tms_rc.active import Active
from tms_rc.following import Follower, ways
from tms_rc.standstill import NOTHING, Expected

DEAD = {"boom": 0.6}


def active(**changes: Any) -> Active:
    nobody: Any = None
    return Active(nobody, None, nobody, {}, {"boom": 0.0}, **changes)


def test_nothing_before_it_has_left() -> None:
    assert active().expected(100.0, DEAD) == NOTHING


def test_a_goal_that_was_not_answered_yet_may_move_the_machine() -> None:
    assert active(sent=99.7).expected(100.0, DEAD) == Expected(99.7)


def test_a_motion_counts_from_when_its_goal_left_and_not_from_when_its_acceptance_was_heard() -> None:
    follower = Follower(ways(["boom"], [(10.0, (1.0,))], {"boom": 0.0}), 1.0, 99.999)
    expected = active(sent=99.9, begun=99.999, follower=follower).expected(100.0, DEAD)
    assert expected.since == 99.9
    assert expected.to_come == {"boom": pytest.approx(0.0001)}


def test_a_reference_that_has_not_moved_yet_need_not_be_seen() -> None:
    follower = Follower(ways(["boom"], [(1.0, (0.0,)), (2.0, (1.0,))], {"boom": 0.0}), 1.0, 99.9)
    assert active(sent=99.9, begun=99.9, follower=follower).expected(100.0, DEAD).since is None
