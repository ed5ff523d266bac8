"""Updates of one record that come within a moment become one."""

from datetime import datetime, timezone

from tms_db.batches import Update
from tms_machine.record_lock import released, taken

NOON = datetime(2026, 1, 31, 12, 0, tzinfo=timezone.utc)
SENSED = Update(1, {"x": 1.0}, NOON, "sp")
LOCK = Update(1, dict(taken("plan", 0.0)), None, "plan")


def test_a_lock_leaves_the_age_and_the_source_of_the_values() -> None:
    assert "updated_at" not in LOCK.stored() and "source" not in LOCK.stored()
    for both in (LOCK.after(SENSED), SENSED.after(LOCK)):
        assert both.stored() == {"x": 1.0, **taken("plan", 0.0), "updated_at": NOON, "source": "sp"}


def test_the_newer_value_wins() -> None:
    assert Update(1, dict(released()), None, "plan").after(LOCK).stored() == released()
    assert Update(1, {"x": 2.0}, NOON, "cli").after(SENSED).stored() == {"x": 2.0, "updated_at": NOON, "source": "cli"}
