"""Which of the gateways' news belong to a run, and which presses of the stop button they have missed."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_decision.duty import HANDED_ON, NOTED
from tms_decision.permit_link import NOBODY
from tms_decision.reasons import SoftwareStop
from tms_reason.wire import to_line
from tms_ts import gateways
from tms_ts.gateways import Gateways, Holder


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


QUIET = SimpleNamespace(
    zero=lambda: None, cancel_everything=lambda: None, warning=lambda *_, **__: None, error=lambda *_, **__: None
)  # fmt: skip


class FakeRos:
    """Keeps who listens to a topic, and what is asked of gateways."""

    def __init__(self) -> None:
        self.heard: dict[str, Callable[[Any], None]] = {}
        self.asked: list[str] = []

    def subscribe(self, _kind: Any, topic: str, hear: Callable[[Any], None], **_quality: Any) -> None:
        self.heard[topic] = hear

    def prepare(self, *_service: Any) -> None:
        pass

    def call_then(self, _kind: Any, name: str, request: StopMachine.Request, _answered: Any) -> None:
        assert not request.orderly and request.cause == to_line(SoftwareStop())
        self.asked.append(name)


class Rig:
    """The gateways of two machines, as the scheduler has them."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.ros = 100.0, FakeRos()
        self.links: dict[str, Any] = {}
        self.changed: dict[str, Callable[[Any], None]] = {}
        monkeypatch.setattr(gateways, "RemotePermit", self._permit)
        monkeypatch.setattr(gateways, "monotonic", lambda: self.now)
        for name in ("Controls", "Permit"):
            monkeypatch.setattr(gateways, name, lambda *_, **__: QUIET)
        site = SimpleNamespace(file=SimpleNamespace(machines=["zx200", "ic120"], pcs={}), border=lambda _: None)
        Gateways(SimpleNamespace(ros=self.ros, pulse=None, site=site, log=QUIET), lambda _: None)  # type: ignore[arg-type]

    def _permit(self, _ros: Any, _pulse: Any, machine: str, _kind: str, changed: Callable[[Any], None]) -> Any:
        self.changed[machine] = changed
        self.links[machine] = SimpleNamespace(alone=True)
        return self.links[machine]

    def press(self) -> None:
        self.ros.heard["/emergency_signal"](Bool(data=True))

    def shows(self, machine: str, latched: bool) -> list[str]:
        """Its gateway tells its state; returns whom the scheduler has asked to stop since the last time."""
        self.ros.asked.clear()
        self.ros.heard[f"/{machine}/rc/state"](MachineState(latch=to_line(SoftwareStop()) if latched else ""))
        return list(self.ros.asked)

    def lose(self, machine: str, *, in_order: bool = False) -> None:
        """Its gateway ends; the next one works at once."""
        link = self.links[machine]
        link.alone = False
        self.changed[machine](SimpleNamespace(alive=False, goal=NOBODY if in_order else b"serves"))
        link.alone = True


@pytest.fixture
def rig(monkeypatch: pytest.MonkeyPatch) -> Rig:
    return Rig(monkeypatch)


ASKED = ["/zx200/rc/stop"]


def test_a_gateway_that_has_missed_a_press_is_told_of_it_without_a_run(rig: Rig) -> None:
    assert rig.shows("zx200", latched=False) == []
    rig.press()
    assert rig.shows("zx200", latched=False) == [], "it may have heard the button itself"
    rig.now += HANDED_ON
    assert rig.shows("zx200", latched=False) == ASKED
    assert rig.shows("zx200", latched=False) == [], "it has been asked just now"
    assert rig.shows("ic120", latched=True) == []


def test_a_release_of_the_button_is_no_press(rig: Rig) -> None:
    rig.ros.heard["/emergency_signal"](Bool(data=False))
    rig.now += HANDED_ON
    assert rig.shows("zx200", latched=False) == []


def test_a_press_is_over_when_its_machine_is_re_armed(rig: Rig) -> None:
    rig.press()
    assert rig.shows("zx200", latched=True) == []
    rig.now += HANDED_ON
    assert rig.shows("zx200", latched=False) == []


@pytest.mark.parametrize("in_order", [True, False])
def test_a_latch_of_a_gateway_that_is_lost_soon_after_may_not_be_on_its_disk(rig: Rig, in_order: bool) -> None:
    rig.press()
    rig.shows("zx200", latched=True)
    rig.lose("zx200", in_order=in_order)
    rig.now += HANDED_ON
    assert rig.shows("zx200", latched=False) == ASKED


def test_a_latch_that_is_shown_for_long_is_on_its_disk(rig: Rig) -> None:
    rig.press()
    rig.now += NOTED
    rig.shows("zx200", latched=True)
    rig.lose("zx200")
    assert rig.shows("zx200", latched=False) == []


def test_two_gateways_of_a_machine_are_not_asked(rig: Rig) -> None:
    """Nobody knows which of them shows its latch."""
    rig.press()
    rig.now += HANDED_ON
    rig.links["zx200"].alone = False
    assert rig.shows("zx200", latched=False) == []
    rig.links["zx200"].alone = True
    assert rig.shows("zx200", latched=False) == ASKED
