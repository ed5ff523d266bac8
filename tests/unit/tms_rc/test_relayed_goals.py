"""A foreign client's goal is lost with the process of ours that has passed it on."""

import uuid
from types import SimpleNamespace
from typing import Any

import pytest

from tms_decision.owner import Owner
from tms_decision.permit_link import LEASE, NOBODY, PermitLink
from tms_rc.relayed_goals import lost_behind
from tms_runtime.fence import derived, goal_id

ASKED = uuid.uuid4().bytes
PLANNED = derived(ASKED) or b""
GOAL = derived(PLANNED) or b""


def gateway(**held: bytes) -> Any:
    """One that has heard at 0 s what processes stand behind."""
    links = {name: PermitLink(name) for name in ("ts", "rp", "st_lift")}
    for name, goal in held.items():
        links[name].heard(goal, "", 0.0)
        links[name].reported(1, 0, late=False, now=0.0)
    return SimpleNamespace(links=links)


@pytest.mark.parametrize("lost", ["rp", "st_lift"])
def test_either_process_behind_the_goal(lost: str) -> None:
    heard = gateway(rp=PLANNED, st_lift=ASKED)
    assert lost_behind(heard, GOAL, 2 * LEASE) == []
    heard.links[lost].reported(0, 1, late=False, now=1.0)
    assert lost_behind(heard, GOAL, 2 * LEASE) == [lost]
    assert lost_behind(heard, uuid.uuid4().bytes, 2 * LEASE) == []  # another client's


def test_a_process_that_is_done_is_not_lost() -> None:
    heard = gateway(rp=PLANNED)
    heard.links["rp"].heard(NOBODY, "", 1.0)
    heard.links["rp"].reported(0, 1, late=False, now=1.0)
    assert lost_behind(heard, GOAL, 2.0) == []


def test_a_client_may_count_its_goals_from_nought() -> None:
    assert lost_behind(gateway(), uuid.UUID(int=1).bytes, 2.0) == []


def test_goals_of_runs_are_not_looked_at() -> None:
    heard = gateway(rp=goal_id(Owner(7, 3, 1)))
    heard.links["rp"].reported(0, 1, late=False, now=1.0)
    assert lost_behind(heard, goal_id(Owner(7, 3, 2)), 2.0) == []
