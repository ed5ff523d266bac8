"""What counts as a loss of a process, and what is only a server that has not found us yet."""

from dataclasses import replace

import pytest

from tms_decision.leaf import effects as f
from tms_decision.leaf import events as e
from tms_decision.leaf.replay import Replay
from tms_decision.leaf.state import ACCEPT_LIMIT, RECOVERY, GoalState, LeafGoal, LeafGoals
from tms_decision.leaf.step import ASK_AGAIN, DATABASE_LIMIT, SERVER_LIMIT, ask, step
from tms_decision.owner import LEAVES, Owner
from tms_decision.reasons import (
    FailedBefore,
    LostTimes,
    MachineLatched,
    NotRepeatedFailed,
    ProcessEnded,
    SentAgainSoon,
    SoftwareStop,
)
from tms_reason.reason import Foreign, Reason
from words import words

RETRIES = 2
POSE: e.Key = ("0", "zx200", "subtask_zx200_change_pose", "pose")
PAST: e.Key = ("0.1", "zx200", "dig", "here")
NO_ANSWER, AWAY, RAIN = Foreign("no answer"), Foreign("away"), Foreign("rain")


class Goals:
    """One machine whose subtask has process 1, a clock that is set by hand, and stops that are told at once."""

    def __init__(self) -> None:
        self.now, self.seen = 0.0, e.Seen(pid=1)
        self.sent: list[int] = []  # sendings
        self.done: list[f.Effect] = []  # all other effects
        self.asked = 0
        self.goals = LeafGoals(1, RETRIES, Replay([(PAST, True)]))
        self.goal = self.ask()

    def ask(self, key: e.Key = POSE) -> LeafGoal:
        self.asked += 1
        goal, effects = ask(self.goals, e.GoalAsked(self.asked, key, self.seen, NO_ANSWER, AWAY), self.now)
        self._do(effects)
        return goal

    def happened(self, event: e.Event) -> list[f.Effect]:
        effects = step(self.goals, event, self.now)
        self._do(effects)
        return effects

    def _do(self, effects: list[f.Effect]) -> None:
        for effect in effects:
            if isinstance(effect, f.Send):
                self.sent.append(effect.call)
            else:
                self.done.append(effect)
            if isinstance(effect, f.StopMachine):
                self.happened(e.MachineStopped(effect.machine))

    def end(self, outcome: str, why: Reason = RAIN, failure: e.Failure = e.NO_LOSS) -> list[f.Effect]:
        """The last sending ends."""
        return self.happened(e.Ended(self.sent[-1], outcome, why, failure))

    def look(self) -> list[f.Effect]:
        return self.happened(e.Looked({goal.asked.number: self.seen for goal in self.goals.open}))

    def retry(self, seconds: float, outcome: str = "") -> None:
        """What a RetryUntilSuccessful around a leaf does, at 20 ticks a second; its goals may all end at once."""
        for _ in range(round(seconds * 20)):
            if outcome and self.goal.call:
                self.end(outcome)
            if self.goal.state.final:
                self.goal = self.ask()
            self.pass_time(0.05)

    def pass_time(self, seconds: float) -> None:
        self.now += seconds
        self.look()

    def lose(self) -> None:
        """The subtask's process ends and is back under another number."""
        self.seen = replace(self.seen, pid=(self.seen.pid or 0) + 1)
        self.pass_time(0.1)
        self.pass_time(RETRIES)  # the goal is sent again

    def notes(self, kind: str = "") -> list[str]:
        found = [effect for effect in self.done if isinstance(effect, f.Note)]
        return [f"{note.kind}: {words(note.what)}" for note in found if note.kind.startswith(kind)]


@pytest.fixture
def site() -> Goals:
    return Goals()


def kept(effects: list[f.Effect]) -> list[f.Effect]:
    return [effect for effect in effects if isinstance(effect, f.KeepSent | f.KeepDone | f.KeepGone)]


def test_a_server_that_never_answers_is_a_loss(site: Goals) -> None:
    for losses in range(1, RETRIES + 1):
        site.pass_time(RECOVERY + ACCEPT_LIMIT)
        assert site.goal.losses == losses
        site.pass_time(RETRIES)
    cancelled = [effect.call for effect in site.done if isinstance(effect, f.Cancel)]
    assert cancelled == site.sent[:RETRIES]  # should they be accepted after all
    site.pass_time(RECOVERY + ACCEPT_LIMIT)
    assert site.goal.reason == LostTimes(NO_ANSWER, RETRIES + 1)
    assert site.goal.state is GoalState.FAILED


def test_a_server_that_does_not_hear_us_soon_after_a_loss_is_asked_again_without_a_further_loss(site: Goals) -> None:
    site.lose()
    assert (site.goal.losses, len(site.sent)) == (1, 2)
    site.pass_time(ACCEPT_LIMIT + 0.1)
    site.pass_time(RETRIES)
    assert (site.goal.losses, len(site.sent)) == (1, 3)
    assert not site.goal.state.final


def test_a_process_that_ends_again_is_a_further_loss_however_soon(site: Goals) -> None:
    site.lose()
    site.lose()
    assert site.goal.losses == RETRIES
    site.lose()
    assert site.goal.state.final
    assert site.goal.reason is not None and site.goal.reason.find(ProcessEnded) is not None


def test_a_process_that_nobody_knew_when_the_goal_was_sent_is_known_later(site: Goals) -> None:
    site.seen = replace(site.seen, pid=None)
    site.ask((*PAST[:3], "there"))
    goal = site.goals.open[-1]
    step(site.goals, e.Looked({goal.asked.number: replace(site.seen, pid=5, age=60.0)}), site.now)
    assert goal.losses == 0
    step(site.goals, e.Looked({goal.asked.number: replace(site.seen, pid=6, age=60.0)}), site.now)
    assert goal.losses == 1


@pytest.mark.parametrize(("age", "losses"), [(0.0, 1), (1.9, 1), (2.1, 0)])
def test_a_process_that_is_younger_than_its_goal_is_another_one(site: Goals, age: float, losses: int) -> None:
    """The host agent was frozen when the goal was sent, and while the subtask was killed and started again."""
    site.seen = replace(site.seen, pid=None)
    site.ask((*PAST[:3], "there"))
    goal = site.goals.open[-1]
    site.happened(e.Accepted(goal.call))
    site.now += 2.0
    step(site.goals, e.Looked({goal.asked.number: replace(site.seen, pid=5, age=age)}), site.now)
    assert goal.losses == losses


def test_the_server_of_a_lost_process_is_left_alone_until_there_is_another(site: Goals) -> None:
    site.seen = replace(site.seen, pid=2)
    assert f.Lose(1, dead=True) in site.look()
    site.pass_time(RETRIES)
    site.seen = replace(site.seen, ready=False)
    assert f.Lose(2, dead=False) in site.look()


def test_the_machine_of_a_lost_goal_is_stopped_before_the_goal_is_sent_again(site: Goals) -> None:
    site.seen = replace(site.seen, pid=2)
    step(site.goals, e.Looked({1: site.seen}), site.now)  # the stop takes its time
    site.pass_time(3 * ASK_AGAIN)
    assert site.sent == [1] and words(site.goal.reason) == "zx200 is being stopped"
    site.happened(e.MachineStopped("zx200"))
    site.look()
    assert site.sent == [1, 2]


def test_a_stop_may_take_longer_than_a_server_may_be_away(site: Goals) -> None:
    site.seen = replace(site.seen, pid=2)
    step(site.goals, e.Looked({1: site.seen}), site.now)
    site.pass_time(SERVER_LIMIT + 2.0)
    assert site.goal.state is GoalState.SENDING
    site.happened(e.MachineStopped("zx200"))
    site.look()
    assert site.sent == [1, 2]


def test_two_stops_of_a_machine_must_both_end(site: Goals) -> None:
    site.goals.stopping += ["zx200", "zx200"]
    site.happened(e.MachineStopped("zx200"))
    assert not site.goals.settled()


@pytest.mark.parametrize(("outcome", "again"), [("SUCCEEDED", True), ("CANCELED", False)])
def test_with_a_goal_that_was_really_done_the_past_is_over(site: Goals, outcome: str, again: bool) -> None:
    if outcome == "CANCELED":
        site.happened(e.CancelAsked(1))
    site.end(outcome)
    after = site.ask(PAST)
    assert (len(site.sent) == 2) is again
    assert after.state is (GoalState.SENDING if again else GoalState.SUCCEEDED)


def test_a_goal_that_failed_before_the_interruption_fails_again_without_a_motion(site: Goals) -> None:
    site.goals.replay = Replay([(PAST, False)])
    goal = site.ask(PAST)
    assert (goal.state, goal.reason, site.sent) == (GoalState.FAILED, FailedBefore(), [1])
    assert f.Note("goal", "0.1", NotRepeatedFailed("zx200:dig")) in site.done


def test_a_goal_that_is_cancelled_while_it_waits_to_be_sent_again_is_never_sent(site: Goals) -> None:
    site.end("REJECTED", failure=e.Failure.NO_STORE)
    site.happened(e.CancelAsked(1))
    site.pass_time(1.0)
    assert site.goal.state is GoalState.CANCELLED
    assert site.sent == [1] and site.goals.settled()


def test_a_machine_gets_no_goal_until_its_cancelled_one_has_ended(site: Goals) -> None:
    assert f.Cancel(1) in site.happened(e.CancelAsked(1))
    other = site.ask(("1", "zx200", "dig", "there"))
    assert site.sent == [1] and words(other.reason) == "zx200 has not ended its last goal yet"
    site.end("CANCELED")
    site.look()
    assert site.sent == [1, 2]


@pytest.mark.parametrize("outcome", ["REJECTED", "ABORTED", "CANCELED"])
def test_a_loop_around_a_goal_that_fails_at_once_floods_nothing(site: Goals, outcome: str) -> None:
    site.retry(2.0, outcome)
    assert 3 <= len(site.sent) <= 1 + 2.0 / ASK_AGAIN
    assert len(site.notes()) < 20
    assert site.goal.reason == SentAgainSoon()


def test_only_the_goal_that_has_failed_waits(site: Goals) -> None:
    site.end("ABORTED")
    other: e.Key = ("1", "zx200", "subtask_zx200_change_pose", "other pose")
    site.ask(other)
    assert len(site.sent) == 2
    site.end("SUCCEEDED")
    site.ask(other)
    assert len(site.sent) == 3


def test_a_goal_that_the_tree_has_halted_is_sent_again_at_once(site: Goals) -> None:
    site.happened(e.CancelAsked(1))
    site.end("CANCELED")
    site.ask()
    assert len(site.sent) == 2


def test_a_process_that_is_given_up_is_told_once(site: Goals) -> None:
    site.end("ABORTED")
    fatal = Foreign("given up")
    site.seen = replace(site.seen, process=fatal, given_up=fatal)
    site.retry(10.0)
    assert site.notes("alarm") == ["alarm: given up"]
    assert site.notes().count("goal: given up") >= 10
    assert len(site.sent) == 1


def test_a_goal_for_a_latched_machine_fails_at_once(site: Goals) -> None:
    site.end("SUCCEEDED")
    site.seen = replace(site.seen, machine=Foreign("latched"), latch=SoftwareStop())
    assert site.ask(PAST).reason == MachineLatched("zx200", SoftwareStop())


def test_a_server_that_does_not_come_is_waited_for_and_then_told(site: Goals) -> None:
    site.end("SUCCEEDED")
    site.seen = replace(site.seen, ready=False)
    goal = site.ask(PAST)
    assert words(goal.reason) == "zx200:dig is not there"
    site.pass_time(SERVER_LIMIT)
    assert goal.state is GoalState.SENDING
    site.pass_time(0.1)
    assert words(goal.reason) == "zx200:dig is not there, for 10.0 s"


def test_after_a_loss_gateway_and_planner_must_be_there_too(site: Goals) -> None:
    site.seen = replace(site.seen, below=Foreign("rp starts"))
    site.end("SUCCEEDED")
    site.ask(PAST)
    assert len(site.sent) == 2  # without a loss they are not waited for: they may belong to another system
    site.lose()
    assert len(site.sent) == 2
    site.seen = replace(site.seen, below=None)
    site.look()
    assert len(site.sent) == 3


def test_a_database_that_is_away_is_waited_for_and_no_longer(site: Goals) -> None:
    while not site.goal.state.final and site.now < 2 * DATABASE_LIMIT:
        if site.goal.call:
            site.end("REJECTED", failure=e.Failure.NO_STORE)
        site.pass_time(ASK_AGAIN)
    assert DATABASE_LIMIT <= site.now < DATABASE_LIMIT + 3 * ASK_AGAIN
    assert set(site.notes("again")) == {"again: rain"}, "the history tells why a goal was sent again"
    assert words(site.goal.reason) == "zx200:subtask_zx200_change_pose refused the goal: rain"


def test_processes_that_do_not_hear_of_each_other_soon_after_a_loss_are_asked_again(site: Goals) -> None:
    site.end("ABORTED", failure=e.Failure.UNREACHED)
    assert site.goal.state is GoalState.FAILED  # without a loss it is a failure like any other
    site.goal = site.ask()
    site.pass_time(ASK_AGAIN)
    site.lose()
    site.end("ABORTED", failure=e.Failure.UNREACHED | e.Failure.LOST)
    assert (site.goal.state, site.goal.losses) == (GoalState.SENDING, 1)
    site.pass_time(RECOVERY)
    site.end("ABORTED", failure=e.Failure.UNREACHED | e.Failure.LOST)
    assert (site.goal.state, site.goal.losses) == (GoalState.SENDING, 2)


def test_a_cancelled_goal_whose_process_is_lost_is_over_and_its_machine_is_stopped(site: Goals) -> None:
    site.happened(e.CancelAsked(1))
    site.seen = replace(site.seen, pid=2)
    effects = site.look()
    assert site.goal.state is GoalState.CANCELLED and site.goals.settled()
    assert any(isinstance(effect, f.StopMachine) for effect in effects)
    assert kept(effects) == []


def test_an_answer_to_a_sending_that_was_given_up_changes_nothing(site: Goals) -> None:
    site.lose()
    site.happened(e.Accepted(1))
    site.happened(e.Ended(1, "ABORTED", Foreign("late")))
    assert (site.goal.state, site.goal.call) == (GoalState.SENDING, 2)


def test_what_is_told_and_kept_of_a_goal_in_its_order(site: Goals) -> None:
    site.happened(e.Accepted(1))
    effects = site.end("SUCCEEDED")
    assert site.notes() == [
        "goal: sent to zx200:subtask_zx200_change_pose, record pose",
        "goal: zx200:subtask_zx200_change_pose accepted",
        "goal: zx200:subtask_zx200_change_pose succeeded",
    ]
    assert kept(site.done)[0] == f.KeepSent(POSE)
    assert kept(effects) == [f.KeepGone(PAST, 1), f.KeepDone(POSE, True)]  # gone for a later resume, too


def test_feedback_of_a_running_goal_changes_nothing(site: Goals) -> None:
    site.happened(e.Accepted(1))
    assert site.happened(e.Accepted(1)) == []


def test_leaves_are_numbered_and_begin_again_after_the_last_number(site: Goals) -> None:
    sent = []
    for calls in (0, LEAVES - 1, LEAVES):
        goals = LeafGoals(7, RETRIES, calls=calls)
        _, effects = ask(goals, e.GoalAsked(1, POSE, e.Seen(), NO_ANSWER, AWAY), 0.0)
        sent += [effect.owner for effect in effects if isinstance(effect, f.Send)]
    assert sent == [Owner(7, 1), Owner(7, LEAVES), Owner(7, 1)]


def test_a_cancel_of_a_goal_that_has_ended_changes_nothing(site: Goals) -> None:
    site.end("SUCCEEDED")
    assert site.happened(e.CancelAsked(1)) == []


def test_a_goal_that_is_being_done_is_left_alone(site: Goals) -> None:
    site.happened(e.Accepted(1))
    assert site.look() == []


def test_a_cancelled_goal_that_fails_is_not_sent_again(site: Goals) -> None:
    site.happened(e.CancelAsked(1))
    site.end("REJECTED", failure=e.Failure.NO_STORE)
    assert site.goal.state is GoalState.FAILED and site.goals.settled()


def test_an_event_of_no_kind_changes_nothing(site: Goals) -> None:
    assert site.happened(e.Event()) == []
