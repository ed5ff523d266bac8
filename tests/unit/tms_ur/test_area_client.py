"""The API asks a gateway as that expects it, and hands on why it refuses."""

from types import SimpleNamespace
from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically

from tms_rc.area_request import escape_request
from tms_rc.reasons import NothingToEscape
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_ur.area_client import let_back


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
