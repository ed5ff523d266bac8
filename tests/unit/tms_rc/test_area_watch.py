"""The gateway's side of areas: a beat takes the last verdict, and one that is missing or old counts as a loss."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from nav2_msgs.action import NavigateToPose

from tms_areas.areas import Area, AreaSet
from tms_areas.escape import SPEED
from tms_areas.fix import Motion, Seen
from tms_areas.guard import Verdict
from tms_areas.reasons import ComesFurtherOut, LeavesArea, PoseUnknown
from tms_config.clock import monotonic, unix_time
from tms_config.config import load_site
from tms_decision.data import Data
from tms_decision.gateway.effects import Receipt
from tms_decision.latch import Latch
from tms_decision.reasons import Cancelled, ProcessLost
from tms_machine.border import MOTIONS
from tms_rc.area_file import AreaFile, Enabled
from tms_rc.area_watch import LATE, AreaWatch
from tms_rc.braking_file import BrakingFile
from tms_rc.reasons import (
    AreasLate,
    AreasNotEnabled,
    EscapesAtRest,
    GoalNotInMap,
    NothingToEscape,
    TrapsMachine,
)
from tms_reason.errors import TmsError

YARD = AreaSet((Area("yard", "unmanned", ((-20, -20), (20, -20), (20, 20), (-20, 20))),))
SMALL = AreaSet((Area("yard", "unmanned", ((-20, -20), (1, -20), (1, 20), (-20, 20))),))
NAVIGATE = next(motion for motion in MOTIONS if motion.field == "navigate_to_pose")
JOINTS = {"vessel_pin_joint": 0.0}


class Ros:
    """Nobody publishes, and the test looks in place of the thread."""

    def __init__(self) -> None:
        self.limits: list[float] = []  # m/s, as told

    def sample(self, *_: Any, **__: Any) -> Any:
        return list

    def subscribe(self, *_: Any, **__: Any) -> None:
        pass

    def publisher(self, *_: Any, **__: Any) -> Any:
        return SimpleNamespace(publish=lambda message: self.limits.append(message.data))

    def poll_in_thread(self, *_: Any) -> None:
        pass


class Goal(Data):
    number: int
    since: float


def watch(
    folder: Path, monkeypatch: pytest.MonkeyPatch, enabled: AreaSet | None = YARD, acts: list[Any] | None = None
) -> AreaWatch:
    monkeypatch.setenv("TMS_STATE", str(folder))
    site = load_site("configs/sites/drill.yaml")
    if enabled is not None:
        AreaFile(folder, "ic120_1").keep(Enabled(enabled, "a person", 0.0))
    log = SimpleNamespace(info=lambda *_, **__: None, warning=lambda *_, **__: None)
    still = SimpleNamespace(moving=lambda: False, positions=JOINTS, sources={})
    gateway: Any = SimpleNamespace(active=None, watch=still, latch=Latch("ic120_1"))
    app: Any = SimpleNamespace(site=site, machine="ic120_1", ros=Ros(), log=log)
    told = [] if acts is None else acts
    return AreaWatch(app, gateway, lambda _: True, lambda *act: told.append(act))


def at(made: AreaWatch, x: float, speed: float = 0.0) -> None:
    """The machine is believed to be somewhere."""
    made._now = lambda: Seen(None, Motion(x, 0.0, 0.0, speed))  # type: ignore[method-assign]


def to(x: float, frame: str = "map") -> NavigateToPose.Goal:
    goal = NavigateToPose.Goal()
    goal.pose.header.frame_id = frame
    goal.pose.pose.position.x, goal.pose.pose.orientation.w = x, 1.0
    return goal


def test_without_enabled_areas_nothing_moves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = watch(tmp_path, monkeypatch, enabled=None)
    gateway: Any = SimpleNamespace(active=Goal(1, monotonic()))
    assert made.unready() == made.astray(gateway) == made.problem(NAVIGATE, to(0.0), JOINTS) == AreasNotEnabled()
    made.enable(YARD, "a person", only_check=True)
    assert made.unready() == AreasNotEnabled()
    made.enable(YARD, "a person", only_check=False)
    assert made.unready() is None and AreaFile(tmp_path, "ic120_1").read().areas == YARD


def test_who_enabled_areas_is_told_and_after_a_restart_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    acts: list[Any] = []
    made = watch(tmp_path, monkeypatch, None, acts)
    made.enable(YARD, "T. Yamada", only_check=True)
    assert acts == []
    made.enable(YARD, "T. Yamada", only_check=False)
    ((what, target, who, at),) = acts
    assert (what, target, who) == ("enable_areas", f"ic120_1 {YARD.id[:8]}", "T. Yamada")
    watch(tmp_path, monkeypatch, None, acts)
    assert acts[1] == acts[0] and at == AreaFile(tmp_path, "ic120_1").read().at


def test_a_beat_takes_the_verdict_of_its_goal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, now = watch(tmp_path, monkeypatch), monotonic()
    gateway: Any = SimpleNamespace(active=None)
    assert made.astray(gateway) is None
    gateway.active = Goal(7, now)
    assert made.astray(gateway) is None  # not looked at yet
    why = LeavesArea("ic120_1", "yard", 0.1, 0.5, 0.0, 0.0)
    made._verdict = now, 7, Verdict(stop=why)
    assert made.astray(gateway) == why
    made._verdict = now, 7, Verdict(hold=AreasNotEnabled())
    assert made.astray(gateway) == ProcessLost(AreasNotEnabled())


def test_a_verdict_that_is_old_or_of_another_goal_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, long_ago = watch(tmp_path, monkeypatch), monotonic() - LATE - 1.0
    gateway: Any = SimpleNamespace(active=Goal(7, long_ago))
    for verdict in (None, (monotonic(), 6, Verdict()), (long_ago, 7, Verdict())):
        made._verdict = verdict
        lost = made.astray(gateway)
        assert isinstance(lost, ProcessLost) and lost.find(AreasLate) is not None


def test_goals_are_judged_from_where_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = watch(tmp_path, monkeypatch)
    at(made, 0.0)
    assert made.problem(NAVIGATE, to(5.0), JOINTS) is None
    assert isinstance(made.problem(NAVIGATE, to(19.0), JOINTS), LeavesArea)
    assert made.problem(NAVIGATE, to(5.0, "odom"), JOINTS) == GoalNotInMap("odom")


def test_areas_that_would_stop_a_moving_machine_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = watch(tmp_path, monkeypatch)
    made._gateway.active = Goal(1, 0.0)  # type: ignore[assignment]
    at(made, 0.0, 0.8)
    with pytest.raises(TmsError) as caught:
        made.enable(SMALL, "a person", only_check=False)
    assert isinstance(caught.value.reason, TrapsMachine) and made.enabled is not None and made.enabled.areas == YARD
    made._gateway.active = None
    made.enable(SMALL, "a person", only_check=False)  # it stands: a person drives it out


def test_a_receipt_enlarges_distances_for_good(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = watch(tmp_path, monkeypatch)
    made._speeds.append((100.0, 0.8))
    made._learn(Receipt(Cancelled(), 100.1, 0, False, True, 2.0, way=2.0))
    factor = BrakingFile(tmp_path, "ic120_1").read()
    assert factor > 1.5
    made._learn(Receipt(Cancelled(), 100.1, 0, False, True, 2.0, way=0.5))
    assert BrakingFile(tmp_path, "ic120_1").read() == factor


def look(made: AreaWatch, x: float) -> None:
    """A look of the watch that believes a place."""
    made._fix = SimpleNamespace(  # type: ignore[assignment]
        odometry=lambda *_: None, look=lambda _: Seen(None, Motion(x, 0.0, 0.0))
    )
    made._look()


def outside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[AreaWatch, list[float], list[Any]]:
    acts: list[Any] = []
    made = watch(folder, monkeypatch, acts=acts)
    look(made, 19.0)
    return made, made._app.ros.limits, acts  # type: ignore[attr-defined]


def test_a_person_lets_a_machine_back_in_slowly(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, limits, acts = outside(tmp_path, monkeypatch)
    assert made.problem(NAVIGATE, to(15.0), JOINTS) is not None
    made.escape("T. Yamada")
    look(made, 19.0)
    assert limits[-1] == SPEED and acts[-1][:3] == ("escape", "ic120_1", "T. Yamada")
    assert made.problem(NAVIGATE, to(15.0), JOINTS) is None
    assert isinstance(made.problem(NAVIGATE, to(22.0), JOINTS), ComesFurtherOut)
    made._gateway.active = Goal(7, monotonic())  # type: ignore[assignment]
    look(made, 18.0)
    assert made.astray(made._gateway) is None
    look(made, 19.0)
    assert isinstance(made.astray(made._gateway), ComesFurtherOut)


def test_the_way_back_ends_inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, limits, _ = outside(tmp_path, monkeypatch)
    made.escape("T. Yamada")
    look(made, 5.0)
    assert limits[-1] == math.inf
    with pytest.raises(TmsError) as caught:
        made.escape("T. Yamada")
    assert caught.value.reason == NothingToEscape("ic120_1")


def test_the_way_back_ends_at_a_stop_and_with_other_areas(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, limits, _ = outside(tmp_path, monkeypatch)
    made.escape("T. Yamada")
    made.stops.put(Receipt(Cancelled(), 0.0, 0, False))  # of the stop before
    look(made, 19.0)
    assert limits[-1] == SPEED
    made.stops.put(Receipt(Cancelled(), unix_time(), 0, False))
    look(made, 19.0)
    assert limits[-1] == math.inf
    made.escape("T. Yamada")
    made.enable(YARD, "a person", only_check=False)
    look(made, 19.0)
    assert limits[-1] == math.inf and made.problem(NAVIGATE, to(15.0), JOINTS) is not None


def test_a_stopped_a_moving_and_a_lost_machine_are_not_let_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, limits, _ = outside(tmp_path, monkeypatch)
    gateway: Any = made._gateway
    for spoil, mend in (
        (lambda: gateway.latch.close(Cancelled()), gateway.latch.open),
        (lambda: setattr(gateway, "active", Goal(7, 0.0)), lambda: setattr(gateway, "active", None)),
        (
            lambda: setattr(gateway.watch, "moving", lambda: True),
            lambda: setattr(gateway.watch, "moving", lambda: False),
        ),
    ):
        spoil()
        with pytest.raises(TmsError) as caught:
            made.escape("T. Yamada")
        assert caught.value.reason == EscapesAtRest("ic120_1")
        mend()
    made._now = lambda: Seen(PoseUnknown(), None)  # type: ignore[method-assign]
    with pytest.raises(TmsError) as caught:
        made.escape("T. Yamada")
    assert caught.value.reason == PoseUnknown() and limits == [math.inf]
