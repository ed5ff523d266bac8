"""A process whose threads do not all run ends, so that supervisord starts a whole one: half a process looks well."""

import os
import threading
from collections.abc import Awaitable, Callable
from functools import partial

import pytest

from conftest import wait_until
from tms_config.clock import monotonic
from tms_ros.node import Ros
from tms_runtime.priority import undisturbed
from tms_runtime.pulse import Pulse

LIMIT = 30.0  # s


def broken() -> None:
    raise RuntimeError("a bug")


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.parametrize(
    "give",
    [
        lambda ros: Pulse(ros).add(broken),
        lambda ros: ros.poll_in_thread(0.1, broken, "looks"),
        lambda ros: ros.every(0.1, broken),
    ],
    ids=["pulse", "beside", "executor"],
)
def test_a_thread_that_dies_of_a_bug_ends_the_process(two_nodes: tuple[Ros, Ros], give: Callable[[Ros], None]) -> None:
    server, other = two_nodes
    give(server)
    wait_until(server.failed.is_set, LIMIT, "the node has failed")
    assert not other.failed.is_set()


def test_an_executor_without_work_looks_all_the_same(two_nodes: tuple[Ros, Ros]) -> None:
    """A wake-up that DDS loses costs a moment, not the process."""
    executor = two_nodes[0].loop._executor
    looks, look = list[float](), executor._run_tasks
    executor._run_tasks = lambda: (looks.append(monotonic()), look())[1]
    wait_until(lambda: len(looks) > 2, LIMIT, "it looks anew, though nothing happens")


def test_a_node_that_is_closed_has_not_failed(own_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(os.environ, "ROS_DOMAIN_ID", str(own_domain))
    node = Ros("server")
    Pulse(node).add(lambda: None)
    before = set(threading.enumerate())
    node.poll_in_thread(0.01, lambda: None, "looks")
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


def test_only_the_thread_that_makes_a_node_comes_before_all_others() -> None:
    """Else what it starts keeps the processors until it has read all answers, and permits of other processes lapse."""
    go = threading.Event()
    started = threading.Thread(target=go.wait)
    nice = os.getpriority(os.PRIO_PROCESS, 0)
    with undisturbed():
        if os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK != os.SCHED_FIFO:
            pytest.skip("needs CAP_SYS_NICE or an RTPRIO limit")
        started.start()
        assert os.sched_getscheduler(_native(started)) == os.SCHED_OTHER
    assert os.sched_getscheduler(0) == os.SCHED_OTHER
    assert os.getpriority(os.PRIO_PROCESS, 0) == nice
    assert os.getpriority(os.PRIO_PROCESS, _native(started)) == nice
    go.set()
    started.join()


def test_threads_keep_the_share_of_their_process(monkeypatch: pytest.MonkeyPatch) -> None:
    changed: dict[int, int] = {}
    monkeypatch.setattr(os, "sched_setscheduler", lambda *_: None)
    monkeypatch.setattr(os, "getpriority", lambda *_: -10)
    monkeypatch.setattr(os, "setpriority", lambda _, number, nice: changed.update({number: nice}))
    go = threading.Event()
    before, started = threading.Thread(target=go.wait), threading.Thread(target=go.wait)
    before.start()
    with undisturbed():
        started.start()
    assert changed[_native(started)] == -10
    assert _native(before) not in changed
    go.set()
    for thread in (before, started):
        thread.join()


def _native(thread: threading.Thread) -> int:
    assert thread.native_id is not None
    return thread.native_id
