"""Asks services of ours, whose answer may be a refusal."""

from tms_interfaces.generated import Reply, Req, ServiceType
from tms_reason.errors import RosError
from tms_reason.wire import refusal
from tms_ros.node import Ros


def ask(ros: Ros, kind: ServiceType[Req, Reply], name: str, request: Req, seconds: float) -> Reply:
    """The answer of a service; from worker threads only.

    Raises:
        RosError: nobody answers within `seconds`; or it refuses, with its code and reason.
    """
    answer = ros.call(kind, name, request, seconds)
    if answer.error_code:
        raise RosError(refusal(answer.error_code, answer.error_msg), answer.error_code)
    return answer
