"""Between the permit and the goal's leaving, a stop or a loss may come."""

from types import SimpleNamespace
from typing import Any

import pytest

from tms_rc.gateway import Gateway
from tms_rc.guard import Active, Guard, Kind
from tms_rc.latch import Latch
from tms_ros.fence import Owner

RUN = Owner(7)
GOAL = Owner(7, 1, 1)  # of the subtask; the scheduler and the subtask stand behind it
HELD = {"ts": RUN, "subtask": Owner(7, 1, 0)}


def stops(held: dict[str, Owner], latched: str = "", owner: Owner | None = GOAL) -> list[tuple[str, Kind]]:
    """What is stopped at the last look at a goal."""
    found: list[tuple[str, Kind]] = []
    guard: Any = Guard.__new__(Guard)
    guard.latch, guard.permits = Latch(latched), SimpleNamespace(held=lambda: held)
    guard.stop_now = lambda cause, kind: found.append((cause, kind))
    guard.last_look(Active(None, owner, None, {}, {}))  # type: ignore[arg-type]
    return found


def test_a_goal_with_everybody_behind_it_leaves() -> None:
    assert stops(HELD) == []


def test_a_stop_that_came_meanwhile_keeps_it() -> None:
    ((cause, kind),) = stops(HELD, "software stop")
    assert "software stop" in cause and kind is Kind.PLAIN


@pytest.mark.parametrize("gone", ["ts", "subtask"])
def test_a_process_that_was_lost_meanwhile_keeps_it(gone: str) -> None:
    ((cause, kind),) = stops({name: what for name, what in HELD.items() if name != gone})
    assert cause.startswith("PROCESS_LOST: no") or "does not stand behind it" in cause
    assert kind is Kind.HOLD


def test_a_run_that_took_the_machine_meanwhile_keeps_a_foreign_goal() -> None:
    ((cause, kind),) = stops(HELD, owner=None)
    assert "held by a run" in cause and kind is Kind.PLAIN


@pytest.mark.parametrize(("answered", "sent"), [(False, 1), (True, 0)])
def test_a_goal_that_was_given_up_while_the_executor_stood_still_does_not_leave(answered: bool, sent: int) -> None:
    left: list[Any] = []
    peer: Any = SimpleNamespace(send=lambda request, **_: left.append(request))
    goal: Any = SimpleNamespace(cancelled=SimpleNamespace(is_set=lambda: False), request="swing", publish=None)
    active = Active(goal, GOAL, peer, {}, {})
    gateway: Any = Gateway.__new__(Gateway)
    gateway._guard = SimpleNamespace(active=None if answered else active, last_look=lambda _: None)
    gateway._send(active)
    assert len(left) == sent
