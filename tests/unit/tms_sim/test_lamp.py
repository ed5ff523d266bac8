"""The lamp of a stand-in shows what its gateway says, and a fault when it says nothing."""

from types import SimpleNamespace
from typing import Any

import pytest
from std_msgs.msg import String

from tms_hardware.lamp import mode
from tms_sim.lamp import SILENT, LampStandIn


@pytest.mark.parametrize(
    ("by_hand", "armed", "ready", "shown"),
    [
        (True, True, True, "manual"), (True, False, False, "manual"), (False, False, True, "stopped"),
        (False, False, False, "stopped"), (False, True, False, "fault"), (False, True, True, "automatic"),
    ],
)  # fmt: skip
def test_the_mode_of_a_machine(by_hand: bool, armed: bool, ready: bool, shown: str) -> None:
    assert mode(by_hand, armed, ready) == shown


def test_a_lamp_that_hears_nothing_shows_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    now, told = [100.0], list[str]()
    monkeypatch.setattr("tms_sim.lamp.monotonic", lambda: now[0])
    publisher = SimpleNamespace(publish=lambda message: told.append(message.data))
    ros = SimpleNamespace(publisher=lambda *_, **__: publisher, subscribe=lambda *_, **__: None, every=lambda *_: None)
    app: Any = SimpleNamespace(ros=ros)
    lamp = LampStandIn(app, "ic120", "mode_lamp")
    assert lamp.shown == "fault"
    for shown in ("automatic", "automatic", "manual"):
        lamp.take(String(data=shown))
    now[0] += SILENT - 0.1
    lamp.look()
    assert lamp.shown == "manual"
    now[0] += 0.2
    lamp.look()
    assert told == ["fault", "automatic", "manual", "fault"]
