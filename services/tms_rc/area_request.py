"""What persons ask a gateway about areas: nothing of it is taken for granted."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import Field, ValidationError
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue

from tms_areas.areas import SHOWN, AreaSet
from tms_areas.geojson import gathered, read
from tms_config.models import Settings
from tms_rc.reasons import AreaRequestBad, AreasOfOtherId, ParameterTwice, Unsigned
from tms_reason.errors import TmsError
from tms_reason.validation import explain


@dataclass(frozen=True)
class AreaRequest:
    """A set that a person wants to count, or wants to know whether it could."""

    areas: AreaSet
    who: str
    only_check: bool


class _Who(Settings):
    who: str = Field(strict=True)


class _Told(_Who):
    id: str = Field(strict=True)
    areas: str = Field(strict=True)  # GeoJSON in map
    only_check: bool = Field(strict=True)


W = TypeVar("W", bound=_Who)


def area_request(parameters: Sequence[Parameter]) -> AreaRequest:
    """The request in parameters `id`, `areas`, `who` and `only_check`, whole and checked.

    `id` is that of the set which the person was shown: what is read here must be the same.

    Raises:
        TmsError: something is missing, of another type, unknown or wrong.
    """
    told = _read(_Told, parameters)
    areas = gathered([read(told.areas, "areas", None)])
    if areas.id != told.id:
        raise TmsError(AreasOfOtherId(told.id[:SHOWN], areas.id[:SHOWN]))
    return AreaRequest(areas, told.who, told.only_check)


def escape_request(parameters: Sequence[Parameter]) -> str:
    """Who lets a machine back in: the parameter `who`.

    Raises:
        TmsError: as for a request to enable areas.
    """
    return _read(_Who, parameters).who


def _read(kind: type[W], parameters: Sequence[Parameter]) -> W:
    names = [one.name for one in parameters]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise TmsError(AreaRequestBad(ParameterTwice(twice)))
    try:
        told = kind.model_validate({one.name: _value(one.value) for one in parameters})
    except ValidationError as error:
        raise TmsError(AreaRequestBad(explain(error))) from error
    if not told.who.strip() or not told.who.isprintable():
        raise TmsError(Unsigned())
    return told


def _value(value: ParameterValue) -> Any:
    if value.type == ParameterType.PARAMETER_STRING:
        return value.string_value
    return value.bool_value if value.type == ParameterType.PARAMETER_BOOL else None
