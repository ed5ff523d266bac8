"""Between the permit and the goal's leaving, a stop or a loss may come."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest

from tms_machine.reasons import MachineLatched, SoftwareStop
from tms_rc.active import Active, StopKind
from tms_rc.gateway import Gateway
from tms_rc.guard import Guard
from tms_rc.latch import Latch
from tms_rc.reasons import HeldByAnother, NoScheduler, NoSubtask, StillMoved
from tms_reason.reason import Reason
from tms_ros.reasons import ProcessLost
from tms_runtime.fence import Owner

Stops = list[tuple[Reason, StopKind]]
RUN = Owner(7)
GOAL = Owner(7, 1, 1)  # of the subtask; the scheduler and the subtask stand behind it
HELD = {"ts": RUN, "subtask": Owner(7, 1, 0)}


def stops(held: dict[str, Owner], latched: Reason | None = None, owner: Owner | None = GOAL) -> Stops:
    """What is stopped at the last look at a goal."""
    found: Stops = []
    guard: Any = Guard.__new__(Guard)
    guard.latch, guard.permits = Latch("zx200", latched), SimpleNamespace(held=lambda: held)
    guard.stop_now = lambda cause, kind: found.append((cause, kind))
    guard.last_look(Active(None, owner, None, {}, {}))  # type: ignore[arg-type]
    return found


def test_a_goal_with_everybody_behind_it_leaves() -> None:
    assert stops(HELD) == []


def test_a_stop_that_came_meanwhile_keeps_it() -> None:
    ((cause, kind),) = stops(HELD, SoftwareStop())
    assert cause == MachineLatched("zx200", SoftwareStop()) and kind is StopKind.PLAIN


@pytest.mark.parametrize("gone", ["ts", "subtask"])
def test_a_process_that_was_lost_meanwhile_keeps_it(gone: str) -> None:
    ((cause, kind),) = stops({name: what for name, what in HELD.items() if name != gone})
    assert cause == ProcessLost(NoScheduler() if gone == "ts" else NoSubtask())
    assert kind is StopKind.HOLD


def test_a_run_that_took_the_machine_meanwhile_keeps_a_foreign_goal() -> None:
    ((cause, kind),) = stops(HELD, owner=None)
    assert cause == HeldByAnother() and kind is StopKind.PLAIN


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


def test_a_goal_waits_for_the_commands_of_the_stop_before_it() -> None:
    settling = iter((True, True, False))
    guard: Any = Guard.__new__(Guard)
    guard._wait_for_permit = lambda owner: None
    guard.press_known = SimpleNamespace(wait=lambda seconds: True)
    guard.stopper = SimpleNamespace(wait_idle=lambda seconds: True)
    guard.controls, guard._taking = SimpleNamespace(settling=lambda: next(settling)), threading.Lock()
    guard.active, guard._app = object(), SimpleNamespace(machine="zx200")
    assert guard.take(SimpleNamespace(owner=GOAL)) == StillMoved("zx200")
    assert next(settling, "none is left") == "none is left"
