"""Foreign goals of a subtask: which are begun, and which end with the border that has passed them on."""

from types import SimpleNamespace
from typing import Any

import pytest
import structlog

from tms_decision.owner import Owner
from tms_kit import foreign_goals
from tms_kit.foreign_goals import ForeignGoals
from tms_reason.reason import Foreign

FOREIGN, OF_A_RUN = bytes(range(16)), Owner(7).goal_id(b"abc")


class Goal:
    """A served goal that notes its cancel."""

    def __init__(self, uuid: bytes) -> None:
        self.uuid, self.id, self.cancels = uuid, uuid.hex(), 0

    def cancel(self) -> None:
        self.cancels += 1


class Border:
    """The permit of `zx200:if` as a subtask sees it."""

    made: list["Border"]

    def __init__(self, _ros: Any, _pulse: Any, machine: str, process: str, changed: Any) -> None:
        assert (machine, process) == ("zx200", "if_dig")
        self.goal, self.alive, self._changed = b"", True, changed
        Border.made.append(self)

    def lost(self, goal: bytes) -> bool:
        return self.goal == goal and not self.alive

    def be(self, goal: bytes, alive: bool) -> None:
        self.goal, self.alive = goal, alive
        self._changed(self)


def goals(monkeypatch: pytest.MonkeyPatch, form: str) -> ForeignGoals:
    Border.made = []
    monkeypatch.setattr(foreign_goals, "RemotePermit", Border)
    monkeypatch.setattr(foreign_goals, "misfit", lambda *_, servers: Foreign("misread"))
    site = SimpleNamespace(other_form=lambda _: form)
    app: Any = SimpleNamespace(
        site=site, machine="zx200", process=SimpleNamespace(action="dig"), ros=None, pulse=None,
        log=structlog.stdlib.get_logger("test"),
    )  # fmt: skip
    return ForeignGoals(app)


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
    (border,) = Border.made
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
    assert Border.made == []
