"""The gateway's side of hardware: a pressed stop latches, a lever holds, a switch on manual ends the goal first."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from std_msgs.msg import Bool, UInt32

from tms_config.clock import monotonic
from tms_config.config import load_site
from tms_decision.gateway.events import Event, Manual
from tms_decision.reasons import ProcessLost
from tms_hardware.reasons import EmergencyStopPressed, LeverLocked, SwitchedToManual
from tms_rc import watch_setup
from tms_rc.hardware_watch import LATE
from tms_rc.motion_servers import MotionServers
from tms_rc.reasons import HardwareLate
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_ros.topics import Arrival

SITE = """
{{name: test, domain: 1, services: {{}}, machines: {{zx200: {{model: zx200, hardware: {{
  emergency_stop: {{topic: relay}}, lock_lever: {{topic: lever}}, manual: {{topic: switch}}, alive: {alive}}}}}}}}}
"""


class Rig:
    """A watch without its thread."""

    def __init__(self, folder: Path, alive: str = "{topic: alive}") -> None:
        file = folder / "site.yaml"
        file.write_text(SITE.format(alive=alive))
        self.waiting: dict[str, list[Any]] = {}
        self.events: list[Event] = []
        self.stops: list[Reason] = []
        self.count = 0
        self.gateway: Any = SimpleNamespace(latch=SimpleNamespace(cause=None), by_hand=None, active=None)
        self.app: Any = SimpleNamespace(site=load_site(str(file)), machine="zx200", ros=self)
        self.people: Any = SimpleNamespace(stop=self.stop, unarmed=[])
        self.servers: Any = SimpleNamespace(watches=[], areas=None)
        shell: Any = SimpleNamespace(happened=self.events.append)
        watch_setup.begin(self.app, shell, self.gateway, self.servers, self.people)
        (self.watch,) = self.servers.watches

    def stop(self, cause: Reason) -> None:
        self.stops.append(cause)
        self.gateway.latch.cause = cause

    def publisher(self, *_: Any, **__: Any) -> None:
        pass

    def sample_arrivals(self, _type: Any, topic: str, *_: Any, **__: Any) -> Any:
        waiting = self.waiting[topic] = []

        def take() -> list[Any]:
            found = list(waiting)
            waiting.clear()
            return found

        return take

    def poll_in_thread(self, *_: Any) -> None:
        pass

    def told(self, *yes: str) -> None:
        """The hardware tells, then the watch looks."""
        self.count += 1
        for name in ("relay", "lever", "switch"):
            self.waiting[f"/zx200/{name}"].append(Arrival(Bool(data=name in yes), monotonic(), 0))
        self.waiting["/zx200/alive"].append(Arrival(UInt32(data=self.count), monotonic(), 0))
        self.watch._look()


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Rig:
    monkeypatch.setenv("TMS_STATE", str(tmp_path))
    return Rig(tmp_path)


def test_a_machine_that_may_move(rig: Rig) -> None:
    rig.told()
    assert rig.watch.unready() is None and rig.watch.astray() is None and rig.stops == [] == rig.events
    assert MotionServers.forbidden(rig.servers) is None and rig.people.unarmed == [rig.watch.unready]


def test_a_pressed_stop_latches_and_keeps_from_arming_until_it_is_released(rig: Rig) -> None:
    rig.told("relay")
    rig.told("relay")
    pressed = EmergencyStopPressed("zx200")
    assert rig.stops == [pressed] and rig.watch.astray() == rig.watch.unready() == pressed
    assert MotionServers.forbidden(rig.servers) == pressed
    rig.told()
    assert rig.watch.unready() is None


def test_a_locked_lever_is_a_loss_that_passes(rig: Rig) -> None:
    rig.told("lever")
    assert rig.watch.unready() == LeverLocked("zx200") and rig.watch.astray() == ProcessLost(LeverLocked("zx200"))
    assert rig.stops == []
    rig.told()
    assert rig.watch.unready() is None


def test_the_switch_is_told_to_the_decisions_once_the_goal_has_ended(rig: Rig) -> None:
    rig.gateway.active = object()
    rig.told("switch")
    assert rig.watch.astray() == ProcessLost(SwitchedToManual("zx200")) and rig.events == []
    rig.gateway.active = None
    rig.told("switch")
    rig.told("switch")
    assert rig.events == [Manual(True)]
    rig.watch._hearing.hardware.heard("manual", monotonic() - 9.0, False)
    rig.watch._look()
    assert rig.events == [Manual(True)]  # a switch of which nobody knows may still stand there
    rig.told()
    assert rig.events == [Manual(True), Manual(False)]


def test_a_look_that_is_old_is_a_loss(rig: Rig) -> None:
    rig.told()
    rig.watch._at -= LATE + 0.1
    wrong = rig.watch.astray()
    assert wrong is not None and wrong.find(HardwareLate) is not None and rig.watch.unready() is not None


@pytest.mark.parametrize("alive", ["{topic: a, type: nothing_msgs/msg/Such}", "{topic: a, field: stamp.sec}"])
def test_a_source_that_cannot_be_is_named(alive: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_STATE", str(tmp_path))
    with pytest.raises(ConfigError) as error:
        Rig(tmp_path, alive)
    assert "hardware.alive" in str(error.value.reason)
