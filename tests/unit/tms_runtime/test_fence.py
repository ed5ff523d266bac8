"""The UUID of a goal tells run, leaf and distance from the scheduler, and is a new one every time."""

import uuid

import pytest

from tms_decision.owner import Owner, parse
from tms_runtime.fence import derived, goal_id, same_client


def test_an_owner_survives_the_uuid() -> None:
    owner = Owner(1_790_000_000_000, 65_535, 2)
    assert parse(goal_id(owner)) == owner
    assert len(goal_id(owner)) == 16
    assert goal_id(owner) != goal_id(owner)


def test_a_derived_goal_is_one_hop_further() -> None:
    below = derived(goal_id(Owner(7, 3)))
    assert below is not None and parse(below) == Owner(7, 3, 1)


@pytest.mark.parametrize(
    "goal_id", [uuid.UUID(int=5).bytes, uuid.uuid4().bytes, b"", b"TMS\x01"], ids=["five", "random", "empty", "short"]
)
def test_foreign_goals_have_no_owner(goal_id: bytes) -> None:
    assert parse(goal_id) is None


def test_what_a_foreign_goal_asks_for_is_known_as_its_own() -> None:
    first, other = uuid.uuid4().bytes, uuid.uuid4().bytes
    below = derived(first)
    assert below is not None and below != first and len(below) == 16 and parse(below) is None
    further = derived(below)
    assert further is not None and same_client(first, below) and same_client(first, further)
    assert not same_client(other, below)


def test_goals_of_runs_are_no_foreign_client_s() -> None:
    of_run = goal_id(Owner(7, 3))
    assert not same_client(of_run, of_run)
