"""What comes into the way of a motion is waited for; the rest of the goal follows by a new plan, a few times."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rc.msg import MachineState

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.reasons import PathBlocked
from tms_decision.owner import Owner
from tms_decision.owner import parse as owner_of
from tms_decision.reasons import DrivenByHand, Held, MachineLatched
from tms_machine.reasons import Busy
from tms_reason import wire
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Foreign, Reason
from tms_ros.goals import Outcome
from tms_rp import resuming
from tms_rp.interventions import Interventions
from tms_rp.kind import Angles, Moves
from tms_rp.kinds import load
from tms_rp.mover import Mover
from tms_rp.plan import Plan
from tms_rp.reasons import PlannedAnew
from tms_rp.resuming import TRIES, Resuming
from tms_rp.scene import Scene
from tms_rp.ways import Ways

WAYS = Ways(parse(CONFIGS / "machines" / "zx200.yaml", MachineModel), load("backhoe"))
NOW: Angles = (-1.571, -0.3, 1.4, 0.5)
FIRST, SECOND = (0.0, *NOW[1:]), (1.571, *NOW[1:])
OWNER = Owner(run=7, leaf=3, hop=1)
TRUCK = PathBlocked(Foreign("ic120_1"), Busy("ic120_1"))


class Gateway:
    """Takes goals, and ends each as the test wants; the first are `seconds` on their way when that happens."""

    name = "/zx200/rc/follow_joint_trajectory"

    def __init__(self, seconds: float, ends: Outcome = Outcome.CANCELED) -> None:
        self._seconds, self._ends = seconds, ends
        self.goals: list[tuple[bytes, Any]] = []
        self.way_blocked = 1  # so many goals

    def wait_ready(self, _: float) -> None:
        pass

    def left(self) -> bool:
        return False

    def send(self, request: Any, *, goal_id: bytes, on_feedback: Any) -> Any:
        self.goals.append((goal_id, request))
        call: Any = SimpleNamespace(accepted=True, outcome=None, result=None, changed=lambda: None)
        call.wait_for = lambda there, _: there()
        sec, rest = divmod(self._seconds, 1)
        at = SimpleNamespace(sec=int(sec), nanosec=int(rest * 1e9))
        on_feedback(SimpleNamespace(desired=SimpleNamespace(time_from_start=at)))
        if not self.blocked():
            call.outcome = Outcome.SUCCEEDED
        return call

    def cancel(self, call: Any) -> None:
        call.outcome = self._ends

    def blocked(self) -> Reason | None:
        return TRUCK if len(self.goals) <= self.way_blocked else None


class Run:
    """One goal, carried out."""

    def __init__(self, gateway: Gateway, monkeypatch: pytest.MonkeyPatch, cancel: bool = False,
                 between: MachineState | None = None, unplannable: int = 0) -> None:  # fmt: skip
        monkeypatch.setattr(resuming, "PAUSE", 0.0)
        self.gateway, self.said, self.rests = gateway, list[Reason](), list[Moves]()
        self._between, self._unplannable = between, unplannable
        self._states: list[Any] = []
        ros: Any = SimpleNamespace(subscribe=lambda _, __, take, **___: self._states.append(take))
        mover: Any = Mover(gateway)  # type: ignore[arg-type]
        self.resuming = Resuming(mover, Interventions(ros, "zx200"), lambda *_: gateway.blocked(), WAYS.late)
        self.goal: Any = SimpleNamespace(cancelled=threading.Event(), uuid=OWNER.goal_id(b"abc"), on_cancel=None)
        self._cancel = cancel

    def move(self, plan: Plan) -> Outcome:
        return self.resuming.move(self.goal, plan, self._again, lambda said, _: self._heard(said))

    def _heard(self, said: Reason) -> None:
        self.said.append(said)
        if isinstance(said, PlannedAnew):  # in the pause
            if self._cancel:
                self.goal.cancelled.set()
            for take in self._states if self._between is not None else ():
                take(self._between)
                take(MachineState())  # it is over already

    def _again(self, rest: Moves) -> Plan:
        self.rests.append(rest)
        if len(self.rests) <= self._unplannable:
            raise SubtaskFailed(Busy("ic120_1"))
        return WAYS.plan(FIRST, rest, Scene())


def plan() -> Plan:
    return WAYS.plan(NOW, Moves((FIRST, SECOND), scales=(0.5, 0.5)), Scene())


def last_angles(gateway: Gateway) -> list[float]:
    return list(gateway.goals[-1][1].trajectory.points[-1].positions)[:4]


def test_the_rest_of_the_goal_follows_with_an_id_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    made = plan()
    gateway = Gateway(made.reached[0] + WAYS.late + 0.1)
    run = Run(gateway, monkeypatch)
    assert run.move(made) is Outcome.SUCCEEDED
    assert run.rests == [Moves((SECOND,), scales=(0.5, 0.5))]
    assert last_angles(gateway) == pytest.approx(SECOND)
    (first, _), (second, _) = gateway.goals
    assert first != second and owner_of(first) == owner_of(second) == OWNER.next()
    assert any(isinstance(said, PlannedAnew) and said.why == TRUCK for said in run.said)


def test_a_target_that_the_arm_may_not_have_reached_yet_is_gone_to_again(monkeypatch: pytest.MonkeyPatch) -> None:
    made = plan()
    run = Run(Gateway(made.reached[0] + WAYS.late - 0.1), monkeypatch)
    run.move(made)
    assert run.rests[0].targets == (FIRST, SECOND)


def test_a_way_that_stays_blocked_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    gateway = Gateway(1.0)
    gateway.way_blocked = 99
    with pytest.raises(SubtaskFailed) as caught:
        Run(gateway, monkeypatch).move(plan())
    assert caught.value.reason == TRUCK and len(gateway.goals) == 1 + TRIES


@pytest.mark.parametrize(("refused", "moves"), [(TRIES - 1, True), (TRIES, False)])
def test_while_there_is_no_way_it_tries_again(monkeypatch: pytest.MonkeyPatch, refused: int, moves: bool) -> None:
    gateway = Gateway(1.0)
    run = Run(gateway, monkeypatch, unplannable=refused)
    if moves:
        assert run.move(plan()) is Outcome.SUCCEEDED
        return
    with pytest.raises(SubtaskFailed) as caught:
        run.move(plan())
    assert caught.value.reason == TRUCK and len(gateway.goals) == 1


def test_a_cancel_in_the_pause_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    gateway = Gateway(1.0)
    assert Run(gateway, monkeypatch, cancel=True).move(plan()) is Outcome.CANCELED
    assert len(gateway.goals) == 1


@pytest.mark.parametrize(
    ("state", "reason"),
    [
        (MachineState(latch=wire.to_line(Busy("x"))), MachineLatched("zx200", Busy("x"))),
        (MachineState(hold=wire.to_line(Busy("x"))), Held(Busy("x"))),
        (MachineState(by_hand=wire.to_line(Busy("x"))), DrivenByHand(Busy("x"), "zx200")),
    ],
)
def test_who_takes_the_machine_in_the_pause_ends_it(
    monkeypatch: pytest.MonkeyPatch, state: MachineState, reason: Reason
) -> None:
    """Also if it was re-armed or given back before the pause is over: somebody else has decided about it."""
    gateway = Gateway(1.0)
    with pytest.raises(SubtaskFailed) as caught:
        Run(gateway, monkeypatch, between=state).move(plan())
    assert caught.value.reason == reason and len(gateway.goals) == 1


def test_a_machine_that_was_not_seen_to_stand_is_not_moved_again(monkeypatch: pytest.MonkeyPatch) -> None:
    gateway = Gateway(1.0, ends=Outcome.ABORTED)
    with pytest.raises(SubtaskFailed):
        Run(gateway, monkeypatch).move(plan())
    assert len(gateway.goals) == 1


def test_stored_plans_are_not_planned_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    gateway, made = Gateway(1.0), plan()
    with pytest.raises(SubtaskFailed) as caught:
        Run(gateway, monkeypatch).move(Plan(made.made, (), Moves(())))
    assert caught.value.reason == TRUCK and len(gateway.goals) == 1
