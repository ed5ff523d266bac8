"""Fencing numbers in the UUIDs of goals."""

import pytest

from tms_decision.owner import Owner, parse


def test_an_owner_comes_back_from_the_uuid_of_its_goal() -> None:
    for owner in (Owner(7), Owner(2**48 - 1, 0xFFFF, 255), Owner(7, 1).next()):
        assert parse(owner.goal_id(b"abc")) == owner
    assert Owner(7, 1, 0).next() == Owner(7, 1, 1)


@pytest.mark.parametrize("goal_id", [b"", bytes(16), b"TMS\x01", bytes(15) + b"T"])
def test_the_goal_of_a_stranger_has_no_owner(goal_id: bytes) -> None:
    assert parse(goal_id) is None
