"""The UUID of a goal tells run, leaf and distance from the scheduler, and is a new one every time."""

import uuid

import pytest

from tms_runtime.fence import Owner, derived, parse


def test_an_owner_survives_the_uuid() -> None:
    owner = Owner(1_790_000_000_000, 65_535, 2)
    assert parse(owner.goal_id()) == owner
    assert len(owner.goal_id()) == 16
    assert owner.goal_id() != owner.goal_id()


def test_a_derived_goal_is_one_hop_further() -> None:
    below = derived(Owner(7, 3).goal_id())
    assert below is not None and parse(below) == Owner(7, 3, 1)


@pytest.mark.parametrize(
    "goal_id", [uuid.UUID(int=5).bytes, uuid.uuid4().bytes, b"", b"TMS\x01"], ids=["five", "random", "empty", "short"]
)
def test_foreign_goals_have_no_owner(goal_id: bytes) -> None:
    assert parse(goal_id) is None
    assert derived(goal_id) is None
