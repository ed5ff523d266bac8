"""LOCK_FLG of a dynamic record, as a lease: from the plan to the end of the motion, sensing does not write it.

In the C++ system it is only a flag, and a crash in between leaves it set for ever. Here the record also has LOCK_OWNER
and LOCK_UNTIL, so that the lock ends by itself. The `_plan` variant of a subtask takes it and releases it when it
fails; the variant that moves always releases it at its end.
"""

from collections.abc import Mapping

from tms_msg_db.srv import SetParameter

from tms_config.clock import unix_time
from tms_machine.values import Value, to_parameters
from tms_reason.errors import SubtaskFailed
from tms_reason.wire import refusal
from tms_ros.node import Ros

FLAG, OWNER, UNTIL = "LOCK_FLG", "LOCK_OWNER", "LOCK_UNTIL"
FIELDS = {FLAG, OWNER, UNTIL}
LEASE = 300.0  # s from planning to the end of the motion
DATABASE_LIMIT = 2.0  # s for the database
SERVICE = "/tms/db/set_parameter"


def holder(fields: Mapping[str, Value], now: float) -> str | None:
    """Who has locked a record, by its fields; None if it is not locked (any more). `now` is Unix time [s].

    A flag without LOCK_UNTIL was set by the C++ system and holds until it is cleared.
    """
    until = fields.get(UNTIL)
    if fields.get(FLAG) is not True or (isinstance(until, (int, float)) and now >= until):
        return None
    return str(fields.get(OWNER) or "a system that gives no name")


def locked_since(fields: Mapping[str, Value], now: float) -> float | None:
    """Unix time [s] since which only its holder changes the record; None if no process holds a lease of it."""
    until = fields.get(UNTIL)
    return until - LEASE if isinstance(until, (int, float)) and holder(fields, now) is not None else None


def taken(owner: str, now: float) -> dict[str, Value]:
    """Fields that lock a record."""
    return {FLAG: True, OWNER: owner, UNTIL: now + LEASE}


def released() -> dict[str, Value]:
    """Fields that release the lock."""
    return {FLAG: False, OWNER: "", UNTIL: 0.0}


class RecordLock:
    """The lock of one record, as a subtask process sees it."""

    def __init__(self, ros: Ros, owner: str, model_name: str, record_name: str) -> None:
        self._ros, self._owner = ros, owner
        self._model_name, self._record_name = model_name, record_name

    def take(self) -> None:
        """Lock the record; from worker threads only.

        Raises:
            SubtaskFailed, RosError: the database refused or did not answer.
        """
        answer = self._ros.call(SetParameter, SERVICE, self._request(taken(self._owner, unix_time())), DATABASE_LIMIT)
        if answer.error_code:
            raise SubtaskFailed(refusal(answer.error_code, answer.error_msg))

    def release(self) -> None:
        """Release the lock, without waiting for an answer: the end of a motion must not depend on a database."""
        self._ros.call_unanswered(SetParameter, SERVICE, self._request(released()))

    def _request(self, values: Mapping[str, Value]) -> SetParameter.Request:
        return SetParameter.Request(
            model_name=self._model_name, record_name=self._record_name, source=self._owner,
            values=to_parameters(values),
        )  # fmt: skip
