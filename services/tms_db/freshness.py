"""Refuses values that are too old: a stale number looks like any other."""

from datetime import datetime, timezone

from tms_core.errors import DbError
from tms_db.records import Document, title


def check(document: Document, max_age: float, now: datetime | None = None) -> None:
    """Refuse a dynamic record that is older than allowed; all ages are by the clock of this PC.

    Args:
        document: the record as stored.
        max_age: s; 0 = as the record says, below 0 = as old as it may be.
        now: for tests.

    Raises:
        DbError: STALE_RECORD; names record, age and limit.
    """
    limit = max_age or document.get("max_age") or 0.0
    if limit <= 0 or document.get("type") == "static":
        return
    where = title(str(document.get("model_name") or ""), str(document.get("record_name")))
    source = document.get("source") or "nobody known"
    updated_at = document.get("updated_at")
    if not isinstance(updated_at, datetime):
        raise DbError(f"{where} may be {limit:g} s old, but nobody knows its age: let sensing write it", "STALE_RECORD")
    age = ((now or datetime.now(timezone.utc)) - updated_at).total_seconds()
    if age > limit:
        text = f"{where} is {age:.1f} s old, allowed are {limit:g} s (last from {source}): see `tms sensing`"
        raise DbError(text, "STALE_RECORD")
