"""The API asks a gateway to end driving by hand as `tms give-back` does, and hands on what it answers."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import TakeMachine

from tms_decision.reasons import GivenBack, NotTaken
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_ur.machine_calls import MachineCalls


def calls(answer: TakeMachine.Response, asked: list[tuple[str, str, bool]]) -> MachineCalls:
    def call(_: Any, service: str, request: TakeMachine.Request, limit: float) -> TakeMachine.Response:
        asked.append((service, request.who, request.back))
        return answer

    ros: Any = SimpleNamespace(peer=lambda *_: None, call=call)
    site: Any = SimpleNamespace(file=SimpleNamespace(machines=(), pcs={}))
    return MachineCalls(ros, site)


def test_a_machine_is_given_back_with_a_receipt() -> None:
    asked: list[tuple[str, str, bool]] = []
    receipt = StopReceipt(machine="zx200", confirmed=True, seconds=0.3, cause=to_line(GivenBack("mina")))
    found = calls(TakeMachine.Response(receipt=receipt), asked).give_back("zx200", "mina at a tablet")
    assert asked == [("/zx200/take", "mina at a tablet", True)]
    assert (found.machine, found.confirmed) == ("zx200", True)


def test_a_refusal_is_handed_on() -> None:
    why = NotTaken("zx200")
    answer = TakeMachine.Response(error_code="NOT_TAKEN", error_msg=to_line(why))
    with pytest.raises(TmsError) as caught:
        calls(answer, []).give_back("zx200", "mina")
    assert caught.value.reason == why
