"""The gateway's side of areas: a beat takes the last verdict, and one that is missing or old counts as a loss."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from nav2_msgs.action import NavigateToPose

from tms_areas.areas import Area, AreaSet
from tms_areas.fix import Motion, Seen
from tms_areas.guard import Verdict
from tms_areas.reasons import LeavesArea
from tms_config.clock import monotonic
from tms_config.config import load_site
from tms_decision.data import Data
from tms_decision.gateway.effects import Receipt
from tms_decision.reasons import Cancelled, ProcessLost
from tms_machine.border import MOTIONS
from tms_rc.area_file import AreaFile, Enabled
from tms_rc.area_watch import LATE, AreaWatch
from tms_rc.braking_file import BrakingFile
from tms_rc.reasons import AreasLate, AreasNotEnabled, GoalNotInMap, TrapsMachine
from tms_reason.errors import TmsError

YARD = AreaSet((Area("yard", "unmanned", ((-20, -20), (20, -20), (20, 20), (-20, 20))),))
SMALL = AreaSet((Area("yard", "unmanned", ((-20, -20), (1, -20), (1, 20), (-20, 20))),))
NAVIGATE = next(motion for motion in MOTIONS if motion.field == "navigate_to_pose")
JOINTS = {"vessel_pin_joint": 0.0}


class Ros:
    """Nobody publishes, and the test looks in place of the thread."""

    def sample(self, *_: Any, **__: Any) -> Any:
        return list

    def subscribe(self, *_: Any, **__: Any) -> None:
        pass

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
    gateway: Any = SimpleNamespace(active=None, watch=still)
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
