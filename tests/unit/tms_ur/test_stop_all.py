"""The console's stop asks all gateways before it waits for one of them."""

import threading
from collections.abc import Callable
from typing import Any

import pytest
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_decision.reasons import SoftwareStopBy
from tms_reason.errors import RosError
from tms_ros.reasons import NoServer
from tms_ur import machine_calls
from tms_ur.machine_calls import MachineCalls

CAUSE = SoftwareStopBy("a person")


class Gateways:
    """Those of r1 to r3 answer when the last was asked, that of `mute` never; that of `late` is not there yet."""

    def __init__(self) -> None:
        self.asked: dict[str, Callable[[Any], None]] = {}
        self.threads: set[int] = set()
        self.called, self.dropped = list[str](), list[str]()

    def call_then(
        self, _kind: object, name: str, _request: object, answered: Callable[[Any], None]
    ) -> Callable[[], None] | None:
        if name.startswith("/late"):
            return None
        self.asked[name] = answered
        self.threads.add(threading.get_ident())
        if name == "/r3/rc/stop":
            for name_of, answer in self.asked.items():
                if not name_of.startswith("/mute"):
                    answer(self._standing(name_of))
        return lambda: self.dropped.append(name)

    def call(self, _kind: object, name: str, _request: object, seconds: float) -> StopMachine.Response:
        self.called.append(name)
        raise RosError(NoServer("late:rc", name, seconds))

    def _standing(self, name: str) -> StopMachine.Response:
        machine = name.split("/")[1]
        return StopMachine.Response(receipt=StopReceipt(machine=machine, confirmed=True))


def test_all_are_asked_by_one_thread_and_each_has_a_receipt(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine_calls, "RECEIPT_LIMIT", 0.2)
    gateways, client = Gateways(), MachineCalls.__new__(MachineCalls)
    client._ros = gateways  # type: ignore[assignment]
    receipts = client.stop(["late", "mute", "r1", "r2", "r3"], CAUSE)
    assert gateways.threads == {threading.get_ident()}
    assert [one.machine for one in receipts if one.confirmed] == ["r1", "r2", "r3"]
    assert [one.machine for one in receipts if not one.confirmed] == ["late", "mute"]
    assert (gateways.called, gateways.dropped) == (["/late/rc/stop"], ["/mute/rc/stop"])
    details = [one.detail.code for one in receipts[:2] if one.detail is not None]
    assert details == ["NO_SERVER", "NO_ANSWER"]
