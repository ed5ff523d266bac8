"""Questions of WaitForClick nodes: all clients show them, and the first answer counts."""

import itertools
import threading
from collections.abc import Callable
from dataclasses import dataclass

from builtin_interfaces.msg import Time
from tms_msg_ts.msg import Question

from tms_reason.reason import Foreign, Reason
from tms_ros.node import Ros
from tms_ts.flags import Answer
from tms_ts.reasons import AnsweredNo, AnsweredYes, NotAnswered

LogEvent = Callable[[str, str, Reason], None]  # kind, node, what


@dataclass(slots=True)
class OpenQuestion:
    """An open question and the node that waits for its answer."""

    message: Question
    answer: Answer[bool]
    clicks: "Clicks"


class Questions:
    """All open questions of this scheduler."""

    def __init__(self, ros: Ros, changed: Callable[[], None]) -> None:
        self._ros, self._changed = ros, changed
        # Ids begin at the present second: none is used again after a restart, and none is the beginning of another one.
        self._numbers = itertools.count(ros.now().sec)
        self._open: dict[str, OpenQuestion] = {}
        self._lock = threading.Lock()

    def messages(self) -> list[Question]:
        """The open questions, for the topic of active runs."""
        with self._lock:
            return [asked.message for asked in self._open.values()]

    def put(self, clicks: "Clicks", title: str, text: str, node: str, seconds: float | None) -> Answer[bool]:
        now = self._ros.now()
        name = f"{clicks.run_id}-{next(self._numbers):010d}"
        until = Time() if seconds is None else _later(now, seconds)
        message = Question(
            id=name, run_id=clicks.run_id, node=node, title=title, text=text, asked_at=now, until=until
        )  # fmt: skip
        answer: Answer[bool] = Answer()
        with self._lock:
            self._open[name] = OpenQuestion(message, answer, clicks)
        clicks.log_event("question", node, Foreign(text or title))
        self._changed()
        return answer

    def answer(self, name: str, yes: bool, by: str) -> bool:
        """Take an answer; False when the question is no longer open."""
        with self._lock:
            asked = self._open.pop(name, None)
        if asked is None:
            return False
        what = AnsweredYes(by) if yes else AnsweredNo(by)
        asked.clicks.log_event("answer", asked.message.node, what)
        asked.answer.settle(yes)
        asked.clicks.wake()
        self._changed()
        return True

    def withdraw(self, answer: object) -> None:
        with self._lock:
            gone = [name for name, asked in self._open.items() if asked.answer is answer]
            for name in gone:
                asked = self._open.pop(name)
                asked.clicks.log_event("answer", asked.message.node, NotAnswered())
        if gone:
            self._changed()


class Clicks:
    """The questions of one run, as its nodes ask them."""

    def __init__(self, questions: Questions, run_id: str, wake: Callable[[], None], log_event: LogEvent) -> None:
        self.run_id, self.wake, self.log_event = run_id, wake, log_event
        self._questions = questions

    def ask(self, title: str, text: str, node: str, seconds: float | None) -> Answer[bool]:
        return self._questions.put(self, title, text, node, seconds)

    def withdraw(self, question: object) -> None:
        self._questions.withdraw(question)


def _later(stamp: Time, seconds: float) -> Time:
    whole = stamp.sec * 10**9 + stamp.nanosec + round(seconds * 1e9)
    return Time(sec=whole // 10**9, nanosec=whole % 10**9)
