"""LOCK_FLG as a lease: it holds, it ends by itself, and a bare flag of the C++ system holds until it is cleared."""

from tms_machine.record_lock import LEASE, holder, locked_since, released, taken


def test_a_lease_holds_and_ends() -> None:
    fields = taken("zx200:subtask_zx200_excavate_simple_plan", 1000.0)
    assert holder(fields, 1000.0) == "zx200:subtask_zx200_excavate_simple_plan"
    assert holder(fields, 1000.0 + LEASE - 1) is not None
    assert holder(fields, 1000.0 + LEASE) is None


def test_a_bare_flag_and_no_flag() -> None:
    assert holder({"LOCK_FLG": True}, 1e9) == "a system that gives no name"
    assert holder({"LOCK_FLG": False, "LOCK_UNTIL": 2e9}, 1e9) is None
    assert holder({"x": 1.0}, 1e9) is None
    assert holder(released(), 1e9) is None


def test_since_when_a_record_is_locked() -> None:
    fields = taken("plan", 1000.0)
    assert locked_since(fields, 1012.0) == 1000.0
    assert locked_since(fields, 1000.0 + LEASE) is None
    assert locked_since({"LOCK_FLG": True}, 1012.0) is None  # a bare flag does not tell
