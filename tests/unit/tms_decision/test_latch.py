"""A stop latches; a lost process only holds the machine for its own run; re-arming takes two steps."""

import pytest

from tms_decision.latch import ANY_LEAF, TOKEN_SECONDS, UNKNOWN_RUN, Latch
from tms_decision.owner import Owner
from tms_decision.reasons import (
    Held,
    MachineLatched,
    NoNote,
    ProcessesLost,
    ProcessLost,
    SoftwareStop,
    ThenSchedulerLost,
    TokenOld,
)

STOP, GONE = SoftwareStop(), ProcessLost(ProcessesLost(("zx200:rp",)))
LOST = Owner(5, 1, 2)  # the goal during which a process was lost
AGAIN = Owner(5, 2, 2)  # the next goal of the same run


def test_armed_at_first() -> None:
    latch = Latch("zx200")
    assert latch.refusal(None) is None and latch.refusal(LOST) is None


def test_a_latched_machine_takes_no_goal_at_all() -> None:
    latch = Latch("zx200")
    latch.close(STOP)
    for owner in (None, LOST, AGAIN):
        assert latch.refusal(owner) == MachineLatched("zx200", STOP)


def test_the_first_cause_stays() -> None:
    latch = Latch("zx200")
    latch.close(STOP)
    latch.close(NoNote())
    assert latch.cause == STOP


def test_only_a_new_goal_of_the_same_run_leaves_a_hold() -> None:
    latch = Latch("zx200")
    latch.keep(GONE, LOST)
    assert latch.refusal(None) is not None
    assert latch.refusal(Owner(6, 2, 2)) is not None
    assert latch.refusal(LOST) is not None  # the very goal that was stopped
    assert latch.refusal(AGAIN) is None
    assert not latch.hold and latch.refusal(None) is None


def test_a_hold_ends_with_its_run_and_becomes_a_latch_with_its_scheduler() -> None:
    latch = Latch("zx200")
    latch.keep(GONE, LOST)
    latch.run_is(5)
    assert latch.hold
    latch.run_is(None)
    assert not latch.hold and not latch.cause
    latch.keep(GONE, LOST)
    latch.run_lost()
    assert latch.cause == ThenSchedulerLost(GONE)


def test_a_hold_of_an_unknown_run_lasts_until_it_is_known() -> None:
    latch = Latch("zx200")
    latch.keep(GONE, Owner(UNKNOWN_RUN, ANY_LEAF))
    latch.run_is(None)
    assert latch.refusal(AGAIN) is not None
    latch.run_is(AGAIN.run)
    assert latch.refusal(AGAIN) is not None
    latch.keep(GONE, Owner(AGAIN.run, ANY_LEAF))
    assert latch.refusal(AGAIN) is None


def test_a_latch_is_not_weakened_by_a_later_loss() -> None:
    latch = Latch("zx200")
    latch.close(STOP)
    latch.keep(GONE, LOST)
    assert latch.cause and latch.refusal(AGAIN) is not None


def test_rearming_needs_the_token_of_the_first_step() -> None:
    latch = Latch("zx200")
    latch.close(STOP)
    assert latch.confirm("guess", 0.0) is not None
    latch.request("t0ken", 0.0)
    assert latch.confirm("t0ken", 1.0) is None
    latch.open()
    assert latch.refusal(None) is None


@pytest.mark.parametrize("spoil", ["used", "late", "stopped", "wrong"])
def test_a_token_is_good_once_for_a_minute_and_for_this_stop(spoil: str) -> None:
    latch = Latch("zx200")
    latch.close(STOP)
    token = "t0ken"
    latch.request(token, 0.0)
    if spoil == "stopped":
        latch.close(NoNote())
    if spoil == "used":
        latch.confirm(token, 1.0)
        latch.close(STOP)
    when = TOKEN_SECONDS + 1 if spoil == "late" else 2.0
    assert latch.confirm("x" if spoil == "wrong" else token, when) is not None
    assert latch.cause


def test_each_closing_is_counted() -> None:
    latch = Latch("zx200")
    for count in (1, 2):
        latch.close(STOP)
        assert latch.closings == count


def test_a_held_machine_says_what_it_is_held_for() -> None:
    latch = Latch("zx200")
    latch.keep(GONE, LOST)
    assert latch.refusal(None) == Held(GONE)


def test_a_token_is_good_until_its_time_is_over() -> None:
    latch = Latch("zx200")
    latch.request("token", 0.0)
    assert latch.confirm("token", TOKEN_SECONDS) is None
    latch.request("token", 0.0)
    assert latch.confirm("token", TOKEN_SECONDS + 0.1) == TokenOld(TOKEN_SECONDS)
