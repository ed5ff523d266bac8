"""A stop is sent before the gateways that have it already go on: else they keep it from the others on a busy PC."""

import os
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_cli.commands.stop import stop
from tms_decision.reasons import SoftwareStop
from tms_reason.wire import to_line
from tms_runtime.priority import URGENT
from tms_runtime.run import FIRST
from tms_ur.machine_calls import MachineCalls

SITE: Any = SimpleNamespace(file=SimpleNamespace(machines=(), pcs={}))


def _unknown(ros: Any) -> MachineCalls:
    ros.call_then = lambda *_: None
    return MachineCalls(ros, SITE)


WAYS: dict[str, Callable[[Any], Any]] = {
    "the console": lambda ros: MachineCalls(ros, SITE).stop(["zx200"], SoftwareStop())[0],
    "the console, before it knows the gateway": lambda ros: _unknown(ros).stop(["zx200"], SoftwareStop())[0],
    "tms stop": lambda ros: stop(ros, "zx200"),
}


@pytest.mark.parametrize("way", WAYS)
def test_a_stop_is_sent_with_the_highest_priority(way: str, monkeypatch: pytest.MonkeyPatch) -> None:
    given, sent = [0], list[int]()
    monkeypatch.setattr(os, "sched_setscheduler", lambda _pid, _policy, param: given.append(param.sched_priority))

    def call(*_: Any) -> StopMachine.Response:
        sent.append(given[-1])
        cause = to_line(SoftwareStop())
        return StopMachine.Response(receipt=StopReceipt(machine="zx200", confirmed=True, cause=cause))

    def call_then(*args: Any) -> Callable[[], None]:
        args[-1](call())
        return lambda: None

    assert WAYS[way](SimpleNamespace(peer=lambda *_: None, call=call, call_then=call_then)).confirmed
    assert (sent, given[-1]) == ([URGENT], 0)
    assert max(realtime for _, realtime in FIRST.values()) < URGENT
