"""Answers of services of ours, which may be refusals."""

from tms_interfaces.generated import Coded, Reply
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign


def checked(answer: Reply) -> Reply:
    """An answer that is no refusal.

    Raises:
        TmsError: the refusal.
    """
    if answer.error_code:
        raise error_in(answer)
    return answer


def error_in(answer: Coded) -> TmsError:
    """The error in an answer."""
    return TmsError(wire.of(answer.error_msg) or Foreign(answer.error_code), answer.error_code)
