"""What persons ask gateways about areas, from the console as from `tms areas`."""

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from tms_reason import wire
from tms_reason.errors import RosError, TmsError
from tms_reason.reason import Reason

if TYPE_CHECKING:  # libraries of areas and messages are loaded only where somebody asks
    from rcl_interfaces.msg import ParameterValue

    from tms_areas.areas import AreaSet
    from tms_ros.node import Ros

LIMIT = 5.0  # s for a gateway to answer; it writes the set to its disk before it does


def not_reached(machine: str, error: RosError) -> TmsError:
    """The error when a gateway does not answer."""
    from tms_areas.reasons import AreasNotReached

    return TmsError(AreasNotReached(machine, error.reason, f"{machine}:rc"))


def let_back(ros: "Ros", machine: str, who: str) -> None:
    """Have a gateway let its machine, which stands outside its areas, be moved back in.

    Raises:
        TmsError: it refuses, or does not answer.
    """
    refused = _ask(ros, machine, "escape", who=who)
    if refused is not None:
        raise TmsError(refused)


def refusals(ros: "Ros", machines: Sequence[str], wanted: "AreaSet", who: str) -> list[Reason]:
    """Why gateways would refuse areas; nothing is enabled.

    Raises:
        TmsError: one of them does not answer.
    """
    found = [_set(ros, machine, wanted, who, only_check=True) for machine in machines]
    return [why for why in found if why is not None]


def enable(ros: "Ros", machines: Sequence[str], wanted: "AreaSet", who: str) -> None:
    """Have all gateways enable areas, after each has said that it would.

    Raises:
        TmsError: one refuses, or does not answer.
    """
    for only_check in (True, False):
        for machine in machines:
            refused = _set(ros, machine, wanted, who, only_check)
            if refused is not None:
                raise TmsError(refused)


def _set(ros: "Ros", machine: str, wanted: "AreaSet", who: str, only_check: bool) -> Reason | None:
    """Why a gateway refuses areas; None: it does not."""
    from tms_areas.geojson import written
    from tms_areas.reasons import AreasNotEnabledBy

    document = json.dumps(written(wanted), ensure_ascii=False)
    why = _ask(ros, machine, "set", id=wanted.id, areas=document, who=who, only_check=only_check)
    return None if why is None else AreasNotEnabledBy(machine, why)


def _ask(ros: "Ros", machine: str, what: str, **told: str | bool) -> Reason | None:
    """Ask a gateway for something about areas; returns why it refuses."""
    from rcl_interfaces.msg import Parameter
    from rcl_interfaces.srv import SetParametersAtomically

    parameters = [Parameter(name=name, value=_value(value)) for name, value in told.items()]
    request = SetParametersAtomically.Request(parameters=parameters)
    try:
        result = ros.call(SetParametersAtomically, f"/{machine}/rc/areas/{what}", request, LIMIT).result
    except RosError as error:
        raise not_reached(machine, error) from error
    return None if result.successful else wire.known(result.reason)


def _value(told: str | bool) -> "ParameterValue":
    from rcl_interfaces.msg import ParameterType, ParameterValue

    if isinstance(told, bool):
        return ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=told)
    return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=told)
