"""A process whose threads do not all run ends, so that supervisord starts a whole one: half a process looks well."""

import os
import threading
from collections.abc import Awaitable, Callable
from functools import partial

import pytest

from conftest import wait_until
from tms_core.ros import Ros
from tms_core.ros.loop import _undisturbed

LIMIT = 30.0  # s


def broken() -> None:
    raise RuntimeError("a bug")


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.parametrize(
    "give",
    [
        lambda ros: ros.pulse.add(broken),
        lambda ros: ros.beside(0.1, broken, "looks"),
        lambda ros: ros.every(0.1, broken),
    ],
    ids=["pulse", "beside", "executor"],
)
def test_a_thread_that_dies_of_a_bug_ends_the_process(two_nodes: tuple[Ros, Ros], give: Callable[[Ros], None]) -> None:
    server, other = two_nodes
    give(server)
    wait_until(server.failed.is_set, LIMIT, "the node has failed")
    assert not other.failed.is_set()


def test_a_node_that_is_closed_has_not_failed(own_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(os.environ, "ROS_DOMAIN_ID", str(own_domain))
    node, before = Ros("server"), set(threading.enumerate())
    node.pulse.add(lambda: None)
    node.beside(0.01, lambda: None, "looks")
    (looks,) = set(threading.enumerate()) - before
    node.close()
    looks.join(LIMIT)
    assert not looks.is_alive() and not node.failed.is_set()


def test_what_is_asked_of_the_executor_runs_in_its_order(two_nodes: tuple[Ros, Ros]) -> None:
    node, _ = two_nodes
    go, ran = threading.Event(), list[str]()
    node.on_executor(lambda: go.wait(LIMIT) and None)  # what comes meanwhile waits together

    def begun(name: str) -> Callable[[], Awaitable[None]]:
        async def step() -> None:
            ran.append(name)

        return step

    for number in range(4):
        node.on_executor(partial(ran.append, f"step {number}"))
        node.start(begun(f"begun {number}"))
    go.set()
    wait_until(lambda: len(ran) == 8, LIMIT, "all of them")
    for kind in ("step", "begun"):
        assert [name for name in ran if name.startswith(kind)] == [f"{kind} {number}" for number in range(4)]


def test_the_thread_that_makes_a_node_gives_way_after_all_that_it_has_started(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise theirs are the processors until they have read all answers, and permits of other processes lapse."""
    changes: list[tuple[int, int]] = []
    monkeypatch.setattr(os, "sched_setscheduler", lambda number, policy, _: changes.append((number, policy)))
    go = threading.Event()
    started = threading.Thread(target=go.wait)
    with _undisturbed():
        started.start()
    go.set()
    started.join()
    assert changes[0] == (0, os.SCHED_FIFO)
    assert {policy for _, policy in changes[1:]} == {os.SCHED_OTHER}
    assert started.native_id in [number for number, _ in changes[1:-1]]
    assert changes[-1][0] == threading.get_native_id()
