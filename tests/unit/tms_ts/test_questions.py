"""Questions of WaitForClick: answered once, withdrawn, timed out; everything is told to the history."""

from dataclasses import dataclass, field

import pytest
from builtin_interfaces.msg import Time

from tms_reason.reason import Foreign
from tms_ts.bt import FAILURE, RUNNING
from tms_ts.questions import Clicks, Questions
from tms_ts.reasons import AnsweredNo, AnsweredYes
from tms_ts.tree_reasons import WaitsForOperator
from unit.tms_ts.fakes import FakeClicks, FakeWorld
from unit.tms_ts.trees import tree


class FakeRos:
    def __init__(self, seconds: int = 100) -> None:
        self.seconds = seconds

    def now(self) -> Time:
        return Time(sec=self.seconds, nanosec=900_000_000)


@dataclass
class Site:
    """A scheduler's questions, and what it was told."""

    changes: int = 0
    wakes: int = 0
    reported: list[tuple[str, str, str]] = field(default_factory=list)
    questions: Questions = field(init=False)
    clicks: Clicks = field(init=False)

    def __post_init__(self) -> None:
        self.questions = Questions(FakeRos(), self._changed)  # type: ignore[arg-type]
        self.clicks = Clicks(self.questions, "r-1", self._wake, lambda *words: self.reported.append(words))

    def _changed(self) -> None:
        self.changes += 1

    def _wake(self) -> None:
        self.wakes += 1


@pytest.fixture
def site() -> Site:
    return Site()


@pytest.mark.parametrize("yes", [True, False])
def test_the_first_answer_counts(site: Site, yes: bool) -> None:
    answer = site.clicks.ask("Safety", "clear?", "0.1", None)
    (shown,) = site.questions.messages()
    assert (shown.run_id, shown.node, shown.title, shown.text) == ("r-1", "0.1", "Safety", "clear?")
    assert (shown.until.sec, shown.until.nanosec) == (0, 0)
    assert not answer.done
    assert site.questions.answer(shown.id, yes, "ken at pc")
    assert (answer.done, answer.value) == (True, yes)
    assert site.wakes == 1
    assert not site.questions.answer(shown.id, not yes, "mina")
    assert answer.value is yes
    assert site.questions.messages() == []
    assert site.reported == [
        ("question", "0.1", Foreign("clear?")),
        ("answer", "0.1", AnsweredYes("ken at pc") if yes else AnsweredNo("ken at pc")),
    ]
    assert site.changes == 2


def test_a_withdrawn_question_cannot_be_answered(site: Site) -> None:
    answer = site.clicks.ask("", "clear?", "0", 2.3)
    (shown,) = site.questions.messages()
    assert (shown.until.sec, shown.until.nanosec) == (103, 200_000_000)
    site.clicks.withdraw(answer)
    assert not site.questions.answer(shown.id, True, "ken")
    assert not answer.done
    assert site.reported[-1][0] == "answer"
    site.clicks.withdraw(answer)  # a second time is nothing new
    assert site.changes == 2


def test_the_nearest_timeout_is_told_and_ends_the_question() -> None:
    body = '<Timeout msec="5000"><Inverter><WaitForClick button_info="go?"/></Inverter></Timeout>'
    fake = FakeWorld(clicks=FakeClicks(None))
    one = tree(body, fake=fake)
    assert one.tick() is RUNNING
    assert fake.clicks.times == [5.0]
    fake.clock.now += 6
    assert one.tick() is FAILURE
    assert fake.clicks.withdrawn == 1


def test_the_reason_names_the_question() -> None:
    fake = FakeWorld(clicks=FakeClicks(None))
    one = tree('<WaitForClick window_title="Safety" button_info="clear?"/>', fake=fake)
    one.tick()
    assert one.running()[0].reason == WaitsForOperator("clear?")


def test_no_id_comes_again_after_a_restart_or_is_the_beginning_of_another_one() -> None:
    ids: list[str] = []
    for second in (9, 100, 1_700_000_000):  # each a new process
        clicks = Clicks(Questions(FakeRos(second), lambda: None), "r-1", lambda: None, lambda *_: None)  # type: ignore[arg-type]
        for _ in range(12):
            clicks.ask("", "clear?", "0", None)
        ids += [question.id for question in clicks._questions.messages()]
    assert len(set(ids)) == len(ids) == 36
    assert len({len(name) for name in ids}) == 1
