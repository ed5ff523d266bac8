"""Who must stand behind a goal before it may move a machine."""

from tms_decision.chain import gap, members
from tms_decision.owner import Owner
from tms_decision.reasons import HeldByAnother, NoPlanner, NoScheduler, NoSubtask, OldRun
from tms_reason.reason import Reason

RUN = Owner(100)
SUBTASK, PLANNER = Owner(100, 4, 0), Owner(100, 4, 1)
GOAL = Owner(100, 4, 2)  # sent by the planner
FULL = {"ts": RUN, "dig": SUBTASK, "rp": PLANNER}


def missing(owner: Owner | None, held: dict[str, Owner]) -> Reason | None:
    found = gap(owner, held)
    return found.reason if found is not None else None


def test_a_complete_chain_may_move() -> None:
    assert gap(GOAL, FULL) is None
    assert members(GOAL, {**FULL, "other": Owner(100, 9, 0)}) == FULL


def test_every_missing_member_is_named() -> None:
    assert missing(GOAL, {"dig": SUBTASK, "rp": PLANNER}) == NoScheduler()
    assert missing(GOAL, {"ts": RUN, "rp": PLANNER}) == NoSubtask()
    assert missing(GOAL, {"ts": RUN, "dig": SUBTASK}) == NoPlanner()
    assert missing(GOAL, {**FULL, "rp": Owner(100, 3, 1)}) == NoPlanner()  # at another goal


def test_an_old_fencing_number_is_refused_at_once() -> None:
    found = gap(Owner(99, 4, 2), FULL)
    assert found is not None and found.late and found.reason == OldRun(99, 100)


def test_a_newer_run_may_still_be_on_its_way() -> None:
    found = gap(Owner(101, 1, 0), FULL)
    assert found is not None and not found.late


def test_foreign_clients_move_only_what_no_run_holds() -> None:
    assert gap(None, {}) is None
    assert missing(None, FULL) == HeldByAnother()
    assert members(None, FULL) == {}
