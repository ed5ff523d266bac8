"""Plans, their simulated histories, and what a history tells: it must not hide what went wrong."""

from typing import Any, get_args

import pytest

from replay import acts as a
from replay.history import History, history, of_machine, of_run
from replay.plans import ONE, PLANS
from replay.seen import LIMIT, Late, Player, Seen
from replay.simulated import Simulated, histories
from simulation.defences import put_out
from simulation.disk import Entry
from simulation.world import Violation
from tms_cli.drill.record import Goal, MotionSample, Receipt, ReportedState, TrialRecording
from tms_decision import reasons as d
from tms_decision.gateway import motion, presses, stops
from tms_proof.standstill import StandStill
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ts.run_states import entered

SEEDS = range(4)


def plan(name: str) -> a.Plan:
    return next(one for one in PLANS if one.name == name)


# plans


@pytest.mark.parametrize("plan", PLANS, ids=lambda plan: plan.name)
def test_a_plan_has_one_history_or_two(plan: a.Plan) -> None:
    told = histories(plan, SEEDS)
    assert 1 <= len(told) <= 2, "\n".join(map(str, told))
    assert any(step.moment for step in plan.steps) and all(one.runs for one in told)


def test_the_plans_use_every_word() -> None:
    used = {type(step.act) for plan in PLANS for step in plan.steps}
    assert used == set(get_args(a.Act))
    faults = {step.act.fault for plan in PLANS for step in plan.steps if isinstance(step.act, a.BeUnkind)}
    assert faults == {*a.Fault, None}
    assert len({plan.name for plan in PLANS}) == len(PLANS) >= 12


def test_a_moment_that_does_not_come_is_told() -> None:
    player = Player(a.Plan("waits", (a.Step(a.Moves(ONE), 0.0, a.Press()),), a.AtOnce()), 10.0)
    seen = Seen({ONE: TrialRecording()})
    assert player.due(seen, 10.0 + LIMIT) is None
    with pytest.raises(Late, match="Moves"):
        player.due(seen, 10.1 + LIMIT)


def test_an_act_comes_after_its_moment_and_the_plan_ends_when_nothing_has_followed() -> None:
    player = Player(a.Plan("waits", (a.Step(a.Moves(ONE), 1.0, a.Press()),), a.AtOnce()), 10.0)
    record = TrialRecording(goals={b"1": Goal(11.0)}, truth=[sample(11.5, 5.0)])
    assert [player.due(Seen({ONE: record}), at) for at in (12.0, 12.9, 13.0)] == [None, None, a.Press()]
    assert player.due(Seen(), 13.0) is None and not player.over
    assert player.due(Seen(), 15.0) is None and player.over


# what breaks is seen


def test_a_gateway_that_looks_at_no_permit_has_another_history(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(motion, "check_chain", lambda gateway, now: None)
    with pytest.raises(Violation, match="moves on"):
        Simulated(plan("a subtask is frozen"), 1).run()


def test_a_gateway_that_believes_everything_has_another_history(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(StandStill, "proven", lambda self, proof, now: True)
    with pytest.raises(Violation, match="truly moving"):
        Simulated(plan("a machine coasts"), 1).run()


def test_a_press_that_does_not_latch_has_another_history(monkeypatch: pytest.MonkeyPatch) -> None:
    name = "a person presses stop, and re-arms"
    right = histories(plan(name), range(1))
    without = lambda gateway, now, cause, kind, **more: stops.stop(gateway, now, cause, stops.StopKind.PLAIN, **more)  # noqa: E731
    monkeypatch.setattr(presses, "stops", type("Stops", (), {"stop": staticmethod(without)}))
    put_out("the scheduler's handing on of a press", monkeypatch.setattr)  # which would latch it by itself
    assert not right & histories(plan(name), range(1))


# what a history tells of a machine


def sample(at: float, share: float) -> MotionSample:
    return MotionSample(at, share, {}, (0.0, 0.0))


def receipt(confirmed: bool = True, begun: float = 10.0, seconds: float = 1.0) -> Receipt:
    return Receipt(begun, seconds, confirmed, to_line(d.SoftwareStop()), "", begun + seconds + 0.1)


def record(*shares: tuple[float, float], receipts: list[Receipt] | None = None, **more: Any) -> TrialRecording:
    return TrialRecording([sample(at, share) for at, share in shares], receipts or [], **more)


def test_a_receipt_is_told_with_the_truth() -> None:
    standing, moving = ((10.0, 5.0), (11.0, 0.2)), ((10.0, 5.0), (11.0, 5.0), (11.1, 3.0))
    assert of_machine(record(*standing, receipts=[receipt()])) == ("is seen to stand, and stands",)
    assert of_machine(record(*moving, receipts=[receipt()])) == ("is seen to stand, and moves",)
    assert of_machine(record(*moving, receipts=[receipt(False)])) == ("is not seen to stand, and moves",)


def test_without_the_truth_nothing_is_told() -> None:
    with pytest.raises(AssertionError, match="true motion"):
        of_machine(record((12.0, 0.0), receipts=[receipt()]))


def test_goals_and_latches_are_told_in_their_order_and_repetitions_once() -> None:
    latch, hold = to_line(d.SoftwareStop()), to_line(d.ProcessLost(d.Cancelled()))
    states = [
        ReportedState(9.0, "", ""), ReportedState(9.5, "", hold), ReportedState(9.7, "", ""),
        ReportedState(10.0, latch, ""), ReportedState(10.5, latch, ""), ReportedState(14.0, "", ""),
    ]  # fmt: skip
    goals = {b"3": Goal(16.0), b"1": Goal(8.0, 10.0), b"2": Goal(15.0, 15.5, arrived=True)}
    told = of_machine(record((11.0, 0.0), receipts=[receipt(), receipt(begun=10.1)], states=states, goals=goals))
    assert told == (
        "moves and is stopped", "is held (PROCESS_LOST)", "is latched (SOFTWARE_STOP)", "is seen to stand, and stands",
        "is armed", "moves and arrives", "moves on",
    )  # fmt: skip


# ... and of a run


def goal(what: Reason, node: str = "0.1", kind: str = "goal") -> Entry:
    return Entry(kind, node, what)


def test_a_run_is_told_by_the_records_of_its_leaves() -> None:
    again = d.SentAgainTimes(d.ProcessEnded("zx200:swing"), 1, 2)
    told = of_run([
        Entry("run", "", entered("running", None)), goal(d.GoalSent("zx200:swing", "left")),
        goal(d.GoalAccepted("zx200:swing")), goal(again, kind="loss"), goal(d.GoalSent("zx200:swing", "left")),
        goal(d.GoalGaveUp("zx200:swing", d.Cancelled())), Entry("stop", "", d.Cancelled()),
        Entry("alarm", "", d.NotSeenStanding(("zx200",))),
        Entry("run", "", entered("cancelled", d.StopRequested("zx200", d.SoftwareStopBy("Sato")))),
    ])  # fmt: skip
    assert told == (
        "is running", "left goal_sent", "left is lost", "left goal_sent", "left is not done",
        "alarm (NOT_SEEN_STANDING)", "is cancelled (SOFTWARE_STOP)",
    )  # fmt: skip


def test_a_history_reads_as_text() -> None:
    told = history(Simulated(plan("a run is cancelled"), 1).run())
    assert isinstance(told, History) and "run a: is preparing, is running" in str(told)
