"""Refuses values that are too old: a stale number looks like a fresh one."""

from datetime import datetime

from tms_config.clock import utc_now
from tms_db.reasons import AgeUnknown, FromFuture, TooOld
from tms_db.records import Document, title
from tms_machine.record_lock import locked_since
from tms_reason.errors import DbError


def check(document: Document, max_age: float, now: datetime | None = None) -> None:
    """Refuse a dynamic record that is older than allowed; all ages are by the clock of this PC.

    The age of a locked record is its age when it was locked: since then the lock itself has kept updates of sensing
    out, and the present motion was planned with these values.

    Args:
        document: the record as stored.
        max_age: s; 0 = as the record says, below 0 = as old as it may be.
        now: for tests.

    Raises:
        DbError: STALE_RECORD; names record, age and limit.
    """
    limit = max_age or document.get("max_age")
    if not isinstance(limit, (int, float)):  # of another system
        return
    if limit <= 0 or document.get("type") == "static":
        return
    where = title(str(document.get("model_name") or ""), str(document.get("record_name")))
    source = document.get("source") or "?"
    updated_at = document.get("updated_at")
    if not isinstance(updated_at, datetime):
        raise DbError(AgeUnknown(where, limit), "STALE_RECORD")
    asked = (now or utc_now()).timestamp()
    if updated_at.timestamp() - asked > limit:  # the clock was set back
        raise DbError(FromFuture(where, source), "STALE_RECORD")
    since = locked_since(document, asked)
    age = (asked if since is None else min(asked, since)) - updated_at.timestamp()
    if age > limit:
        raise DbError(TooOld(where, age, limit, source), "STALE_RECORD")
