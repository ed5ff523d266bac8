"""What the API asks gateways about areas."""

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParametersAtomically

from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_ur.reason_view import view
from tms_ur.watch_models import AreaChange, AreasChecked, EnabledAreas

if TYPE_CHECKING:  # its libraries are loaded only where somebody draws areas
    from tms_areas.areas import AreaSet

LIMIT = 4.0  # s for an answer of a gateway


def let_back(ros: Ros, machine: str, who: str) -> None:
    """Let a machine that stands outside its areas be moved back in.

    Raises:
        TmsError: refused, with the reason.
    """
    refused = _ask(ros, machine, "escape", who=who)
    if refused is not None:
        raise TmsError(refused)


def check_areas(ros: Ros, machines: Iterable[str], now: EnabledAreas, document: dict[str, Any]) -> AreasChecked:
    """What would change if areas were enabled, and which machines would refuse.

    Raises:
        TmsError: the areas make no sense, or a gateway does not answer.
    """
    from tms_areas.changes import changes

    wanted, before = _read(document), None if now.id is None else _read(now.areas)
    refused = [_enable(ros, machine, wanted, "nobody", only_check=True) for machine in machines]
    found = [AreaChange.model_validate(vars(one)) for one in changes(before, wanted)]
    return AreasChecked(id=wanted.id, changes=found, refusals=[view(why) for why in refused if why is not None])


def enable_areas(ros: Ros, machines: Iterable[str], document: dict[str, Any], shown: str, who: str) -> str:
    """Have all gateways enable areas, after each has said that it would; returns the id of the set.

    `shown`: the id of the set that the person was shown.

    Raises:
        TmsError: it is another set, it makes no sense, or a gateway refuses or does not answer.
    """
    from tms_areas.reasons import AreasNotShown

    wanted = _read(document)
    if wanted.id != shown:
        raise TmsError(AreasNotShown())
    all_machines = list(machines)
    for only_check in (True, False):
        for machine in all_machines:
            refused = _enable(ros, machine, wanted, who, only_check)
            if refused is not None:
                raise TmsError(refused)
    return wanted.id


def _read(document: dict[str, Any]) -> "AreaSet":
    from tms_areas.geojson import gathered, read

    return gathered([read(json.dumps(document), "areas", None)])


def _enable(ros: Ros, machine: str, wanted: "AreaSet", who: str, only_check: bool) -> Reason | None:
    """Why a gateway refuses areas; None: it does not."""
    from tms_areas.geojson import written
    from tms_areas.reasons import AreasNotEnabledBy

    document = json.dumps(written(wanted), ensure_ascii=False)
    why = _ask(ros, machine, "set", id=wanted.id, areas=document, who=who, only_check=only_check)
    return None if why is None else AreasNotEnabledBy(machine, why)


def _ask(ros: Ros, machine: str, what: str, **told: str | bool) -> Reason | None:
    """Ask a gateway for something about areas; returns why it refuses."""
    request = SetParametersAtomically.Request(
        parameters=[Parameter(name=name, value=_value(value)) for name, value in told.items()]
    )
    result = ros.call(SetParametersAtomically, f"/{machine}/rc/areas/{what}", request, LIMIT).result
    return None if result.successful else wire.known(result.reason)


def _value(told: str | bool) -> ParameterValue:
    if isinstance(told, bool):
        return ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=told)
    return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=told)
