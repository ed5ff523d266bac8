"""Questions of subtasks: which run they belong to, and how each of their ends looks to the machine."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_ur.action import NextStepPermission

from conftest import wait_until
from tms_decision.owner import Owner
from tms_ros.goals import Outcome
from tms_ts.permissions import Permissions
from tms_ts.questions import Questions

LIMIT = 20.0  # s
OF_RUN_7, FOREIGN = Owner(7, 1, 1).goal_id(b"abc"), bytes(range(16))


class Asked:
    """One goal, served in a thread, and the questions that are open meanwhile."""

    def __init__(self, uuid: bytes, machinename: str = "zx200,next_step") -> None:
        self.told: list[tuple[str, str]] = []
        run: Any = SimpleNamespace(facts=SimpleNamespace(number=7, run_id="r7"),
                                   log_event=lambda kind, node, what: self.told.append((kind, what.code)))  # fmt: skip
        runs: Any = [run]
        ros: Any = SimpleNamespace(now=lambda: Time(sec=1000))
        self.questions = Questions(ros, lambda: None)
        self.goal: Any = SimpleNamespace(uuid=uuid, cancelled=threading.Event(), on_cancel=None,
                                         request=NextStepPermission.Goal(machinename=machinename))  # fmt: skip
        self.ended: list[Any] = []
        permissions = Permissions(runs, self.questions)
        self.thread = threading.Thread(target=lambda: self.ended.append(permissions.run(self.goal)), daemon=True)
        self.thread.start()
        wait_until(lambda: bool(self.questions.messages()), LIMIT, "a question")
        (self.question,) = self.questions.messages()

    def cancel(self) -> None:
        self.goal.cancelled.set()
        self.goal.on_cancel()

    def end(self) -> tuple[Outcome, bool]:
        self.thread.join(LIMIT)
        outcome, result = self.ended[0]
        assert not self.questions.messages()
        return outcome, result.success


@pytest.mark.parametrize(("yes", "end"), [(True, (Outcome.SUCCEEDED, True)), (False, (Outcome.ABORTED, False))])
def test_the_answer_of_a_person_ends_the_goal(yes: bool, end: tuple[Outcome, bool]) -> None:
    asked = Asked(OF_RUN_7)
    assert (asked.question.run_id, asked.question.title, asked.question.text) == ("r7", "zx200", "next_step")
    assert asked.questions.answer(asked.question.id, yes, "mina")
    assert asked.end() == end
    assert [kind for kind, _ in asked.told] == ["question", "answer"]


def test_a_cancel_withdraws_the_question() -> None:
    asked = Asked(OF_RUN_7)
    asked.cancel()
    assert asked.end() == (Outcome.CANCELED, False)
    assert asked.told[-1] == ("answer", "NOT_ANSWERED")


def test_a_foreign_node_may_ask_too() -> None:
    asked = Asked(FOREIGN, "ic120")
    assert (asked.question.run_id, asked.question.title, asked.question.text) == ("", "ic120", "ic120")
    assert asked.questions.answer(asked.question.id, True, "mina")
    assert asked.end() == (Outcome.SUCCEEDED, True)
    assert asked.told == []
