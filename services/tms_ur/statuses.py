"""The HTTP status of each reason, by its code."""

from http import HTTPStatus

from tms_reason.reason import Reason
from tms_ur.reasons import Throttled

# A code that is not in this table is a refusal (409): the request is valid, but not possible now.
STATUS = {
    **dict.fromkeys(("TASK_MISSING", "RUN_MISSING", "RECORD_MISSING", "NO_RUN", "NO_TREE"), HTTPStatus.NOT_FOUND),
    **dict.fromkeys(("NO_QUESTION", "NO_PROCESS", "UNKNOWN_PROCESS", "NO_MACHINE"), HTTPStatus.NOT_FOUND),
    **dict.fromkeys(("GROUND_NOT_THERE", "RUN_NOT_FOUND"), HTTPStatus.NOT_FOUND),
    **dict.fromkeys(("NO_SERVER", "NO_ANSWER", "RUN_NOT_BEGUN"), HTTPStatus.SERVICE_UNAVAILABLE),
    **dict.fromkeys(("STORE_DOWN", "STORE_FULL", "TOO_MANY_CONSOLES"), HTTPStatus.SERVICE_UNAVAILABLE),
    "LOGIN": HTTPStatus.UNAUTHORIZED,
    "ROLE": HTTPStatus.FORBIDDEN,
    **dict.fromkeys(("THROTTLED", "MANY_LOGINS"), HTTPStatus.TOO_MANY_REQUESTS),
}  # fmt: skip


def retry_after(reason: Reason) -> dict[str, str] | None:
    """The header with the time until the next try; None where the reason names none."""
    return {"Retry-After": str(round(reason.seconds) + 1)} if isinstance(reason, Throttled) else None
