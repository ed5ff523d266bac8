"""The API asks a gateway as that expects it, and hands on why it refuses."""

from types import SimpleNamespace
from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically

from tms_areas.reasons import AreasNotEnabledBy, AreasNotShown
from tms_rc.area_request import AreaRequest, area_request, escape_request
from tms_rc.reasons import NothingToEscape
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_ur.area_client import check_areas, enable_areas
from tms_ur.gateway_areas import let_back
from tms_ur.watch_models import EnabledAreas


def gateway(result: SetParametersResult, asked: list[tuple[str, str]]) -> Any:
    def call(_: Any, service: str, request: SetParametersAtomically.Request, limit: float) -> Any:
        asked.append((service, escape_request(request.parameters)))
        return SetParametersAtomically.Response(result=result)

    return SimpleNamespace(call=call)


def test_who_lets_a_machine_back_and_why_not() -> None:
    asked: list[tuple[str, str]] = []
    let_back(gateway(SetParametersResult(successful=True), asked), "zx200", "mina at a tablet")
    assert asked == [("/zx200/rc/areas/escape", "mina at a tablet")]
    why = NothingToEscape("zx200")
    with pytest.raises(TmsError) as caught:
        let_back(gateway(SetParametersResult(successful=False, reason=to_line(why)), asked), "zx200", "mina")
    assert caught.value.reason == why


def drawn(side: float) -> dict[str, Any]:
    ring = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side], [0.0, 0.0]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    yard = {"type": "Feature", "properties": {"id": "yard", "type": "unmanned"}, "geometry": geometry}
    return {"type": "FeatureCollection", "frame": "map", "features": [yard]}


def gateways(asked: list[tuple[str, AreaRequest]], refusing: str = "") -> Any:
    """Those of two machines; each answers as a real one reads the request."""

    def call(_: Any, service: str, request: SetParametersAtomically.Request, limit: float) -> Any:
        machine = service.split("/")[1]
        asked.append((machine, area_request(request.parameters)))
        refused = machine == refusing
        result = SetParametersResult(
            successful=not refused, reason=to_line(NothingToEscape(machine)) if refused else ""
        )
        return SetParametersAtomically.Response(result=result)

    return SimpleNamespace(call=call)


def test_a_check_tells_what_changes_and_who_refuses() -> None:
    asked: list[tuple[str, AreaRequest]] = []
    now = EnabledAreas(id="9f", areas=drawn(10.0))
    found = check_areas(gateways(asked, "ic120"), ["zx200", "ic120"], now, drawn(8.0))
    (change,) = found.changes
    assert (change.kind, change.before, change.after, change.away) == ("changed", 100.0, 64.0, 36.0)
    assert [one.code for one in found.refusals] == ["AREAS_NOT_ENABLED_BY"]
    assert [(machine, one.only_check) for machine, one in asked] == [("zx200", True), ("ic120", True)]


def test_areas_are_enabled_where_no_gateway_refuses() -> None:
    asked: list[tuple[str, AreaRequest]] = []
    shown = check_areas(gateways([]), [], EnabledAreas(id=None), drawn(8.0)).id
    enable_areas(gateways(asked), ["zx200", "ic120"], drawn(8.0), shown, "mina")
    assert [one.only_check for _, one in asked] == [True, True, False, False]
    assert {one.who for _, one in asked} == {"mina"}
    asked.clear()
    with pytest.raises(TmsError) as caught:
        enable_areas(gateways(asked, "ic120"), ["zx200", "ic120"], drawn(8.0), shown, "mina")
    assert isinstance(caught.value.reason, AreasNotEnabledBy)
    assert all(one.only_check for _, one in asked)  # no gateway has them
    with pytest.raises(TmsError) as caught:
        enable_areas(gateways(asked), ["zx200"], drawn(9.0), shown, "mina")
    assert caught.value.reason == AreasNotShown()
