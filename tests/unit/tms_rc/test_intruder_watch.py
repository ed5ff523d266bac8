"""The gateway's side of trackers: who is inside has the machine latched, and keeps it so; an old look is a loss."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import Point, Pose, PoseArray
from std_msgs.msg import Bool, Header

from tms_areas.areas import Area, AreaSet
from tms_areas.reasons import APerson, GateOpened, IntruderInside, IntruderNear, TrackerSilent
from tms_config.clock import monotonic
from tms_config.config import load_site
from tms_decision.reasons import Cancelled, ProcessLost
from tms_rc.area_file import Enabled
from tms_rc.intruder_watch import LATE, NEAR, IntruderWatch
from tms_rc.latch_order import AGAIN
from tms_rc.reasons import IntrudersLate
from tms_reason.reason import Reason
from tms_ros.topics import Arrival

AREAS = AreaSet(
    (
        Area("fence", "restricted", ((10, -10), (15, -10), (15, 10), (10, 10))),
        Area("yard", "unmanned", ((-10, -10), (10, -10), (10, 10), (-10, 10))),
    )
)
SENSING = """
trackers:
  eye: {kind: person, topic: eye, silent_after: 5}
  tag: {kind: person, topic: tag, on_silence: hold, silent_after: 5}
  gate: {kind: gate, topic: gate, type: std_msgs/msg/Bool, areas: [yard], on_silence: warn}
"""


class Rig:
    """A watch without its thread, before a gateway whose latch is closed at once."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("TMS_STATE", str(folder))
        file = folder / "site.yaml"
        (folder / "sensing.yaml").write_text(SENSING)
        file.write_text(
            "{name: test, domain: 1, sensing: sensing.yaml, services: {}, machines: {ic120: {model: ic120}}}"
        )
        self.waiting: dict[str, list[Any]] = {}
        self.stops: list[Reason] = []
        self.gateway: Any = SimpleNamespace(latch=SimpleNamespace(cause=None), by_hand=None, active=None)
        self.speed = SimpleNamespace(able=True, set=lambda _, limit: self.limits.append(limit))
        self.limits: list[float] = []
        areas: Any = SimpleNamespace(enabled=Enabled(AREAS, "a person", 0.0), here=(0.0, 0.0), speed=self.speed)
        log = SimpleNamespace(warning=lambda *_, **__: None)
        app: Any = SimpleNamespace(site=load_site(str(file)), machine="ic120", ros=self, log=log)
        self.watch = IntruderWatch(app, self.gateway, areas, lambda number: number == 1, self.stop)

    def stop(self, cause: Reason) -> None:
        self.stops.append(cause)
        self.gateway.latch.cause = cause

    def sample_arrivals(self, _type: Any, topic: str, *_: Any, **__: Any) -> Any:
        waiting = self.waiting[topic] = []

        def take() -> list[Any]:
            found = list(waiting)
            waiting.clear()
            return found

        return take

    def poll_in_thread(self, *_: Any) -> None:
        pass

    def told(self, *people: tuple[float, float], gate: tuple[bool, ...] = (False,), tag: bool = True) -> None:
        """Everybody tells, then the watch looks."""
        poses = [Pose(position=Point(x=x, y=y)) for x, y in people]
        self.waiting["eye"].append(arrival(PoseArray(header=Header(frame_id="map"), poses=poses)))
        if tag:
            self.waiting["tag"].append(arrival(PoseArray(header=Header(frame_id="map"))))
        self.waiting["gate"] += [arrival(Bool(data=opened)) for opened in gate]
        self.watch._look()


def arrival(message: Any) -> Arrival[Any]:
    return Arrival(message, monotonic(), 0)


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Rig:
    return Rig(tmp_path, monkeypatch)


def inside(x: float, y: float) -> Reason:
    return IntruderInside("ic120", APerson(), "yard", "eye", x, y)


def test_a_person_inside_latches_once_and_keeps_from_arming(rig: Rig) -> None:
    rig.told()
    assert rig.watch.unready(True) is None and rig.watch.unarmed() is None and rig.stops == []
    rig.told((3.0, 4.0))
    rig.told((3.0, 4.0))
    assert rig.stops == [rig.watch.astray()] == [rig.watch.unarmed()] == [inside(3.0, 4.0)]
    rig.told()
    assert rig.watch.unarmed() is None


def test_a_machine_that_is_armed_all_the_same_is_latched_again(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    rig.told((3.0, 4.0))
    rig.gateway.latch.cause = None
    now = monotonic()
    monkeypatch.setattr("tms_rc.intruder_watch.monotonic", lambda: now + AGAIN + 0.1)
    rig.told((3.0, 4.0))
    assert len(rig.stops) == 2


def test_a_machine_in_a_persons_hands_is_left_to_that_person(rig: Rig) -> None:
    rig.gateway.by_hand = Cancelled()
    rig.told((3.0, 4.0), gate=(True, False))
    assert rig.stops == []
    rig.gateway.by_hand = None
    rig.told()
    assert rig.stops == [GateOpened("ic120", "gate", ("yard",))]


def test_who_comes_near_slows_tracks_and_stops_what_cannot_be_slowed(rig: Rig) -> None:
    rig.told((14.0, 0.0))
    near = rig.watch.danger.warn
    assert isinstance(near, IntruderNear) and rig.limits == [NEAR] and rig.stops == []
    assert rig.watch.unready(True) is None and rig.watch.unready(False) == ProcessLost(near)
    for number, wrong in ((1, None), (2, ProcessLost(near))):
        rig.gateway.active = SimpleNamespace(number=number)
        assert rig.watch.astray() == wrong
    rig.speed.able = False
    assert rig.watch.unready(True) == ProcessLost(near)
    rig.told()
    assert rig.limits == [NEAR, math.inf] and rig.watch.unready(True) is None


def test_a_gate_counts_until_the_machine_is_armed(rig: Rig) -> None:
    rig.told()
    rig.told(gate=(True, False))
    opened = GateOpened("ic120", "gate", ("yard",))
    assert rig.stops == [opened] and rig.watch.unready(True) == opened and rig.watch.unarmed() is None
    rig.told()
    assert rig.watch.unready(True) == opened and len(rig.stops) == 1
    rig.gateway.latch.cause = None
    rig.told()
    assert rig.watch.unready(True) is None and len(rig.stops) == 1


def test_a_gate_that_opens_between_the_steps_of_a_rearm_voids_it(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    rig.told(gate=(True, False))
    now = monotonic()
    monkeypatch.setattr("tms_rc.intruder_watch.monotonic", lambda: now + AGAIN + 0.1)
    rig.told(gate=(True, False))
    assert len(rig.stops) == 2  # closes the latch anew


def test_a_tracker_that_only_holds_does_not_latch(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    rig.told()
    later = monotonic() + 6.0
    monkeypatch.setattr("tms_rc.intruder_watch.monotonic", lambda: later)
    rig.waiting["eye"].append(Arrival(PoseArray(header=Header(frame_id="map")), later, 0))
    rig.watch._look()
    wrong = rig.watch.astray()
    assert isinstance(wrong, ProcessLost) and wrong.find(TrackerSilent) is not None
    assert rig.stops == [] and rig.watch.unarmed() is not None


def test_a_look_that_is_old_is_a_loss(rig: Rig) -> None:
    rig.told()
    rig.watch._at -= LATE + 0.1
    assert rig.watch.astray() is not None
    wrong = rig.watch.unready(True)
    assert isinstance(wrong, ProcessLost) and wrong.find(IntrudersLate) is not None
