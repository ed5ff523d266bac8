"""The permit of another process, as DDS reports it."""

from tms_decision.permit_link import GRACE, LEASE, PermitLink

GOAL = b"g" * 16


def test_a_process_that_was_never_heard_has_neither_worked_nor_left() -> None:
    link = PermitLink("rc")
    link.reported(0, 0, False, 1.0)
    assert not link.alive(1.0) and not link.left


def test_a_message_counts_for_a_lease_before_the_report_comes() -> None:
    link = PermitLink("rc")
    link.heard(GOAL, "run-1", 1.0)
    assert link.alive(1.0 + LEASE - 0.01) and not link.alive(1.0 + LEASE)
    link.reported(1, 0, False, 1.1)
    assert link.alive(1e9)


def test_a_process_that_nobody_has_seen_asserted_since_its_message_is_lost() -> None:
    """It was killed just after the message: DDS has nothing to report."""
    link = PermitLink("ts")
    assert not link.judge(9.0), "no message, nothing to lose"
    link.heard(GOAL, "run-1", 10.0)
    asked = [10.0 + LEASE - 0.01, 10.0 + LEASE, 10.0 + LEASE + GRACE - 0.01, 10.0 + LEASE + 1.01 * GRACE, 99.0]
    assert [link.judge(now) for now in asked] == [False, False, False, True, False]
    link.heard(GOAL, "run-1", 100.0)
    assert not link.judge(100.0 + LEASE)
    link.reported(1, 1, False, 100.0 + LEASE + 0.01)  # it came after all
    assert not link.judge(200.0) and link.alive(200.0)


def test_a_process_that_ends_in_order_has_left_and_one_that_is_killed_has_not() -> None:
    for not_alive, left in ((0, True), (1, False)):
        link = PermitLink("rc")
        link.reported(1, 0, False, 1.0)
        link.reported(0, not_alive, False, 2.0)
        assert link.left is left


def test_on_a_pc_that_was_late_a_loss_is_judged_a_moment_later() -> None:
    link = PermitLink("rc")
    link.heard(GOAL, "", 1.0)
    link.reported(1, 0, False, 1.0)
    link.reported(0, 1, True, 2.0)
    assert not link.judge(2.0 + GRACE - 0.01) and link.alive(2.0 + GRACE - 0.01)
    assert link.judge(2.0 + GRACE) and not link.alive(2.0 + GRACE)
