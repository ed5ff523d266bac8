"""However a run ends, its machines are stopped, and no permit is held before it may move or after it has stopped."""

import pytest

from tms_decision import STOP_PROVEN
from tms_decision.reasons import GoalNotEnded, HaltedGoalsEnd, NotResumed, SoftwareStop, StopRequested
from tms_decision.run import effects as f
from tms_decision.run import events as e
from tms_decision.run.step import SETTLE_LIMIT, TICK_LIMIT, Phase, Run, step
from tms_reason.reason import Foreign, Several

RAIN = Foreign("it rains")


def after(*events: e.Event, run: Run | None = None) -> tuple[Run, list[f.Effect]]:
    """A run to which this has happened, a second apart; and what it then wanted last."""
    run = run or Run()
    effects: list[f.Effect] = []
    for second, event in enumerate(events):
        effects = step(run, event, float(second))
    return run, effects


RUNNING = (e.Prepared(), e.Held())


def test_permits_are_held_before_it_runs() -> None:
    assert after(e.Prepared())[1] == [f.Hold()]
    assert after(*RUNNING)[1] == [f.Enter("running")]


def test_a_machine_that_was_stopped_meanwhile_refuses_it() -> None:
    run, effects = after(e.Prepared(), e.Held(RAIN))
    assert effects == [f.KeepEnd("refused", RAIN), f.Enter("refused", RAIN, True), f.Forget(), f.Drop()]
    assert (run.phase, run.refused) == (Phase.OVER, RAIN)


def test_refused_before_it_held_permits_it_drops_none() -> None:
    assert after(e.Refused(RAIN))[1] == [f.KeepEnd("refused", RAIN), f.Enter("refused", RAIN, True), f.Forget()]


def test_a_resume_that_is_refused_stays_interrupted() -> None:
    effects = after(e.Refused(RAIN), run=Run(resumed=True))[1]
    assert effects == [f.Enter("interrupted", NotResumed(RAIN), True), f.KeepInterrupted()]


def test_cancelled_while_it_is_prepared_it_is_not_ticked() -> None:
    run, effects = after(e.EndAsked("cancelled"), e.Prepared(), e.Held(RAIN))
    assert (run.phase, effects) == (Phase.HALTING, [f.Enter("running"), f.Enter("stopping"), f.Halt()])


@pytest.mark.parametrize(
    ("event", "outcome", "why"),
    [
        (e.Ticked("failure", RAIN), "failure", RAIN),
        (e.EndAsked("interrupted", RAIN), "interrupted", RAIN),
        (e.StoppedOutside("zx200", RAIN), "failure", StopRequested("zx200", RAIN)),
        (e.StoppedOutside("zx200", SoftwareStop()), "cancelled", StopRequested("zx200", SoftwareStop())),
    ],
)
def test_whatever_ends_it_its_tree_is_halted_and_then_its_machines_are_stopped(
    event: e.Event, outcome: str, why: Foreign
) -> None:
    run, effects = after(*RUNNING, event)
    assert effects == [f.Enter("stopping", why), f.Halt()]
    assert step(run, e.Halted(False), 9.0) == [f.StopMachines(outcome)]


def test_the_first_who_ends_it_counts() -> None:
    run, _ = after(e.EndAsked("cancelled"), e.StoppedOutside("zx200", RAIN), *RUNNING)
    assert (run.outcome, run.why) == ("cancelled", None)


def test_a_success_that_leaves_nothing_open_stops_nobody() -> None:
    effects = after(*RUNNING, e.Ticked("success", RAIN), e.Halted(False))[1]
    assert effects == [f.KeepEnd("success", None), f.Enter("success", None, True), f.Forget(), f.Drop()]


def test_a_tree_that_succeeds_while_a_halted_leaf_still_moves_has_its_machine_seen_to_stop() -> None:
    run, effects = after(*RUNNING, e.Ticked("success", RAIN), e.Halted(True))
    assert effects == [f.Enter("stopping", HaltedGoalsEnd()), f.StopMachines("success")]
    assert step(run, e.Stood([]), 5.0) == []
    assert step(run, e.Looked(True, ["zx200:dig"]), 6.0) == []
    ended = step(run, e.Looked(False, []), 7.0)
    assert ended == [f.KeepEnd("success", None), f.Enter("success", None, True), f.Forget(), f.Drop()]


def test_a_machine_that_was_not_seen_to_stand_is_an_alarm_and_no_success() -> None:
    run, _ = after(*RUNNING, e.Ticked("success"), e.Halted(True), e.Stood([RAIN]))
    effects = step(run, e.Looked(False, []), 9.0)
    assert effects[0] == f.Alarm(RAIN)
    assert effects[1] == f.KeepEnd("stop_unconfirmed", Several((RAIN,)))


def test_a_goal_that_never_ends_is_waited_for_and_no_longer() -> None:
    run, _ = after(*RUNNING, e.EndAsked("cancelled", RAIN), e.Halted(True), e.Stood([]))
    begun = 4.0
    assert step(run, e.Looked(True, ["zx200:dig"]), begun + SETTLE_LIMIT - 0.1) == []
    effects = step(run, e.Looked(True, ["zx200:dig"]), begun + SETTLE_LIMIT)
    assert effects[:2] == [
        f.Alarm(GoalNotEnded("zx200:dig")),
        f.KeepEnd("stop_unconfirmed", Several((GoalNotEnded("zx200:dig"), RAIN))),
    ]
    assert SETTLE_LIMIT > STOP_PROVEN


def test_an_interrupted_run_keeps_its_checkpoint() -> None:
    run, _ = after(*RUNNING, e.EndAsked("interrupted", RAIN), e.Halted(False), e.Stood([]))
    assert step(run, e.Looked(False, []), 9.0) == [
        f.Enter("interrupted", RAIN, True), f.KeepInterrupted(), f.Drop(),
    ]  # fmt: skip


def test_its_permits_lapse_when_it_is_not_ticked_and_only_then() -> None:
    run, _ = after(e.Prepared())
    assert run.works(1e9)
    run, _ = after(*RUNNING)
    assert run.works(1.0 + TICK_LIMIT - 0.01) and not run.works(1.0 + TICK_LIMIT + 0.01)
    step(run, e.Ticked(), 5.0)
    assert run.works(5.1)
    step(run, e.Ticked("failure"), 6.0)
    assert run.works(1e9)  # its machines are being stopped


def test_what_comes_at_another_time_changes_nothing() -> None:
    run, _ = after(e.Refused(RAIN))
    for event in (e.Prepared(), e.Held(), e.Ticked("success"), e.Halted(True), e.Stood([]), e.Looked(False, [])):
        assert step(run, event, 9.0) == []
    assert step(run, e.Refused(RAIN), 9.0) == [] and run.phase is Phase.OVER
