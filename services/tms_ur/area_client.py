"""What the API does with areas that a person has drawn."""

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ur import gateway_areas
from tms_ur.reason_view import view
from tms_ur.watch_models import AreaChange, AreasChecked, EnabledAreas

if TYPE_CHECKING:  # its libraries are loaded only where somebody draws areas
    from tms_areas.areas import AreaSet


def check_areas(ros: Ros, machines: Sequence[str], now: EnabledAreas, document: dict[str, Any]) -> AreasChecked:
    """What would change if areas were enabled, and which machines would refuse.

    Raises:
        TmsError: the areas make no sense, or a gateway does not answer.
    """
    from tms_areas.changes import changes

    wanted, before = _read(document), None if now.id is None else _read(now.areas)
    refused = gateway_areas.refusals(ros, machines, wanted, "nobody")
    found = [AreaChange.model_validate(vars(one)) for one in changes(before, wanted)]
    return AreasChecked(id=wanted.id, changes=found, refusals=list(map(view, refused)))


def enable_areas(ros: Ros, machines: Sequence[str], document: dict[str, Any], shown: str, who: str) -> str:
    """Have all gateways enable areas; returns the id of the set.

    `shown`: the id of the set that the person was shown.

    Raises:
        TmsError: it is another set, it makes no sense, or a gateway refuses or does not answer.
    """
    from tms_areas.reasons import AreasNotShown

    wanted = _read(document)
    if wanted.id != shown:
        raise TmsError(AreasNotShown())
    gateway_areas.enable(ros, machines, wanted, who)
    return wanted.id


def _read(document: dict[str, Any]) -> "AreaSet":
    from tms_areas.geojson import gathered, read

    return gathered([read(json.dumps(document), "areas", None)])
