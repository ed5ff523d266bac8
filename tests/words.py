"""Reasons as people read them, for tests of texts."""

from tms_reason import texts, wire
from tms_reason.reason import Reason


def words(what: Reason | str | None) -> str:
    """English of a reason, or of the line that carries it; empty for none."""
    reason = wire.of(what) if isinstance(what, str) else what
    return "" if reason is None else texts.text(reason, "en")
