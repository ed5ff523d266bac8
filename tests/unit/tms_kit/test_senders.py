"""Goals of a subtask: which foreign ones are begun, and which goals end with the process that has sent them."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
import structlog

from tms_decision.owner import Owner
from tms_decision.permit_link import NOBODY
from tms_kit import senders
from tms_kit.senders import Senders
from tms_reason.reason import Foreign

FOREIGN, OF_A_RUN = bytes(range(16)), Owner(7, 1).goal_id(b"abc")
SCHEDULED = Owner(7).goal_id(b"ts0")  # the scheduler stands behind that run


class Goal:
    """A served goal that notes its cancel."""

    def __init__(self, uuid: bytes) -> None:
        self.uuid, self.id, self.cancels = uuid, uuid.hex(), 0

    def cancel(self) -> None:
        self.cancels += 1


class Question:
    """A peer of the scheduler."""

    lost = False

    def mark_lost(self) -> None:
        self.lost = True

    def mark_alive(self) -> None:
        self.lost = False


later: list[Callable[[], None]] = []  # what the executor does when its time has come


class Sender:
    """The permit of a process that has sent the goal."""

    made: list["Sender"]

    def __init__(self, _ros: Any, _pulse: Any, machine: str, process: str, changed: Any) -> None:
        assert machine == "zx200"
        self.process, self.goal, self.alive, self._changed = process, b"", True, changed
        Sender.made.append(self)

    def lost(self, goal: bytes) -> bool:
        return self.goal == goal and not self.alive

    def be(self, goal: bytes, alive: bool) -> None:
        self.goal, self.alive = goal, alive
        self._changed(self)


def goals(monkeypatch: pytest.MonkeyPatch, form: str, *, waits: bool = False) -> Senders:
    Sender.made = []
    later.clear()
    monkeypatch.setattr(senders, "RemotePermit", Sender)
    monkeypatch.setattr(senders, "misfit", lambda *_, servers: Foreign("misread"))
    site = SimpleNamespace(other_form=lambda _: form)
    app: Any = SimpleNamespace(
        site=site, machine="zx200", process=SimpleNamespace(action="dig"), pulse=None,
        ros=SimpleNamespace(after=lambda _, step: later.append(step)),
        log=structlog.stdlib.get_logger("test"),
    )  # fmt: skip
    return Senders(app, waits=waits)


def test_a_misread_client_refuses_foreign_goals_and_none_of_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    foreign = goals(monkeypatch, "")
    whole: Any = Goal
    assert foreign.refusal(whole(FOREIGN)) == Foreign("misread")
    assert foreign.refusal(whole(OF_A_RUN)) is None


def test_with_a_border_the_border_has_looked(monkeypatch: pytest.MonkeyPatch) -> None:
    whole: Any = Goal
    assert goals(monkeypatch, "v6b").refusal(whole(FOREIGN)) is None


def test_a_goal_ends_with_the_border_that_has_passed_it_on(monkeypatch: pytest.MonkeyPatch) -> None:
    foreign, goal = goals(monkeypatch, "v6b"), Goal(FOREIGN)
    whole: Any = goal
    foreign.watch(whole)
    (border,) = Sender.made
    assert border.process == "if_dig"
    border.be(FOREIGN, alive=True)
    border.be(b"another", alive=False)
    assert goal.cancels == 0
    border.be(FOREIGN, alive=False)
    assert goal.cancels == 1
    foreign.watch(None)
    border.be(FOREIGN, alive=False)
    assert goal.cancels == 1


@pytest.mark.parametrize(("form", "uuid"), [("v6b", OF_A_RUN), ("", FOREIGN)])
def test_goals_that_no_border_passes_are_not_watched(monkeypatch: pytest.MonkeyPatch, form: str, uuid: bytes) -> None:
    whole: Any = Goal(uuid)
    goals(monkeypatch, form).watch(whole)
    assert Sender.made == []


def waiting(monkeypatch: pytest.MonkeyPatch) -> tuple[Senders, Goal, Sender]:
    """A goal that waits, and the permit of its scheduler, which stands behind it."""
    goal = Goal(OF_A_RUN)
    whole: Any = goal
    watched = goals(monkeypatch, "", waits=True)
    watched.watch(whole)
    (scheduler,) = Sender.made
    assert scheduler.process == "ts"
    scheduler.be(SCHEDULED, alive=False)  # not heard of yet
    scheduler.be(SCHEDULED, alive=True)
    return watched, goal, scheduler


@pytest.mark.parametrize("then", [(SCHEDULED, False), (NOBODY, False)])
def test_a_goal_that_waits_ends_with_its_scheduler(monkeypatch: pytest.MonkeyPatch, then: tuple[bytes, bool]) -> None:
    watched, goal, scheduler = waiting(monkeypatch)
    question: Any = Question()
    watched.add(question)
    scheduler.be(*then)
    assert (goal.cancels, question.lost) == (0, False)
    later.pop()()
    assert (goal.cancels, question.lost) == (1, True)


def test_a_scheduler_that_is_back_in_time_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    _, goal, scheduler = waiting(monkeypatch)
    scheduler.be(SCHEDULED, alive=False)
    scheduler.be(SCHEDULED, alive=True)
    later.pop()()
    assert goal.cancels == 0


def test_another_run_ends_it_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    _, goal, scheduler = waiting(monkeypatch)
    scheduler.be(Owner(8).goal_id(b"ts1"), alive=True)
    assert goal.cancels == 1


def test_a_goal_of_a_lost_scheduler_is_known_to_end_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    goals_of_runs, goal, scheduler = waiting(monkeypatch)
    assert not goals_of_runs.gone
    scheduler.be(SCHEDULED, alive=False)
    assert goals_of_runs.gone
    scheduler.be(SCHEDULED, alive=True)
    assert not goals_of_runs.gone
    scheduler.be(Owner(8).goal_id(b"ts0"), alive=True)
    assert goal.cancels == 1 and goals_of_runs.gone, "cancelled, and not over yet"
    goals_of_runs.watch(None)
    assert not goals_of_runs.gone


def test_the_next_goal_is_seen_by_the_permit_that_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = Goal(OF_A_RUN), Goal(Owner(7, 2).goal_id(b"abd"))
    whole: list[Any] = [first, second]
    watched = goals(monkeypatch, "", waits=True)
    watched.watch(whole[0])
    (scheduler,) = Sender.made
    scheduler.be(SCHEDULED, alive=True)
    watched.watch(None)
    watched.watch(whole[1])
    scheduler.be(SCHEDULED, alive=False)
    later.pop()()
    assert (first.cancels, second.cancels, len(Sender.made)) == (0, 1, 1)
