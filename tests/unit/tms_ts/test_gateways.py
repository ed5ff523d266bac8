"""Which of the gateways' news belong to a run, and which presses of the stop button they have missed."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_config.clock import monotonic
from tms_decision.duty import NOTED
from tms_decision.permit_link import NOBODY
from tms_decision.reasons import Cancelled, SoftwareStop
from tms_reason.wire import to_line
from tms_ts import gateways
from tms_ts.gateways import Gateways, Holder
from tms_ts.machine_stops import MachineStops


@pytest.mark.parametrize(
    ("run", "at", "concerns"),
    [
        (7, 100, True),
        (7, 99, True),  # by the gateway's clock, which is not ours
        (6, 101, False),  # of an earlier run, told again by a gateway that has just started
        (0, 101, True),  # before the gateway heard that a run holds the machine
        (0, 99, False),  # of a machine that nobody held, told again
    ],
)
def test_a_run_hears_of_its_own_stops_only(run: int, at: int, concerns: bool) -> None:
    holder = Holder(7, (100, 0), lambda *_: None, lambda _: None, lambda: True)
    assert holder.concerns(StopReceipt(run=run, stamp=Time(sec=at, nanosec=1))) is concerns


QUIET = SimpleNamespace(zero=lambda: None, cancel_everything=lambda: None, warning=lambda *_, **__: None)


class FakeRos:
    """Keeps who listens to a topic, and what is asked of gateways."""

    def __init__(self) -> None:
        self.heard: dict[str, Callable[[Any], None]] = {}
        self.asked: list[StopMachine.Request] = []

    def subscribe(self, _kind: Any, topic: str, hear: Callable[[Any], None], **_quality: Any) -> None:
        self.heard[topic] = hear

    def prepare(self, *_service: Any) -> None:
        pass

    def call(self, _kind: Any, _name: str, request: StopMachine.Request, *_limits: Any) -> StopMachine.Response:
        self.asked.append(request)
        return StopMachine.Response()


def test_a_gateway_that_has_missed_a_press_is_asked_to_latch(monkeypatch: pytest.MonkeyPatch) -> None:
    changed: dict[str, Callable[[Any], None]] = {}

    def made(_ros: Any, _pulse: Any, machine: str, _kind: str, told: Callable[[Any], None]) -> Any:
        changed[machine] = told
        return SimpleNamespace(alive=True)

    monkeypatch.setattr(gateways, "RemotePermit", made)
    for name in ("Controls", "Permit"):
        monkeypatch.setattr(gateways, name, lambda *_, **__: QUIET)
    site = SimpleNamespace(file=SimpleNamespace(machines=["zx200", "ic120"], pcs={}), border=lambda _: None)
    ros = FakeRos()
    app: Any = SimpleNamespace(ros=ros, pulse=None, site=site, log=QUIET)
    known = Gateways(app, lambda _: None)
    stops = MachineStops(ros, known, lambda *_: None)  # type: ignore[arg-type]
    state = ros.heard["/zx200/rc/state"]

    def asked(machine: str) -> tuple[bool, str]:
        stops.stop(machine, Cancelled())
        return ros.asked[-1].orderly, ros.asked[-1].cause

    orderly, missed = (True, to_line(Cancelled())), (False, to_line(SoftwareStop()))
    ros.heard["/emergency_signal"](Bool(data=False))
    assert asked("zx200") == asked("ic120") == orderly
    ros.heard["/emergency_signal"](Bool(data=True))
    state(MachineState())
    assert asked("zx200") == asked("ic120") == missed
    state(MachineState(latch=to_line(SoftwareStop())))
    assert asked("zx200") == orderly and asked("ic120") == missed
    changed["zx200"](SimpleNamespace(alive=False, goal=b"serves"))  # so soon that its disk may not have it
    assert asked("zx200") == missed
    ros.heard["/emergency_signal"](Bool(data=True))
    state(MachineState(latch=to_line(SoftwareStop())))
    ros.heard["/emergency_signal"](Bool(data=True))  # somebody goes on pressing a machine that shows its latch
    state(MachineState())
    assert asked("zx200") == orderly, "it was re-armed"
    state(MachineState(latch=to_line(SoftwareStop())))
    changed["zx200"](SimpleNamespace(alive=False, goal=NOBODY))  # the next one has shown nothing yet
    ros.heard["/emergency_signal"](Bool(data=True))
    assert asked("zx200") == missed
    monkeypatch.setattr(gateways, "monotonic", lambda: monotonic() + NOTED)
    state(MachineState(latch=to_line(SoftwareStop())))
    changed["zx200"](SimpleNamespace(alive=False, goal=b"serves"))
    assert asked("zx200") == orderly
