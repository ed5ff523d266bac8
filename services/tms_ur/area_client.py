"""What the API asks gateways about areas."""

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParametersAtomically

from tms_reason import wire
from tms_reason.errors import TmsError
from tms_ros.node import Ros

LIMIT = 4.0  # s for an answer of a gateway


def let_back(ros: Ros, machine: str, who: str) -> None:
    """Let a machine that stands outside its areas be moved back in.

    Raises:
        TmsError: refused, with the reason.
    """
    value = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=who)
    request = SetParametersAtomically.Request(parameters=[Parameter(name="who", value=value)])
    result = ros.call(SetParametersAtomically, f"/{machine}/rc/areas/escape", request, LIMIT).result
    if not result.successful:
        raise TmsError(wire.refusal("", result.reason))
