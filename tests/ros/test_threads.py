"""A process whose threads do not all run ends, so that supervisord starts a whole one: half a process looks well."""

import os
import threading
import weakref
from collections.abc import Awaitable, Callable
from functools import partial

import pytest
from structlog.contextvars import bind_contextvars, get_contextvars

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


def test_calls_that_block_at_once_have_a_thread_each(two_nodes: tuple[Ros, Ros]) -> None:
    loop, together, met = two_nodes[0].loop, threading.Barrier(4), list[int]()

    def work() -> None:
        together.wait(LIMIT)
        met.append(threading.get_ident())

    for _ in range(4):
        loop.on_executor(lambda: loop.in_thread(work))
    wait_until(lambda: len(met) == 4, LIMIT, "all four are there at once")
    assert len(set(met)) == 4


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_thread_does_one_work_after_the_other_and_keeps_nothing_of_it(two_nodes: tuple[Ros, Ros]) -> None:
    loop, done = two_nodes[0].loop, list[tuple[int, dict[str, object]]]()

    def work(kept: set[int] | None = None) -> None:
        done.append((threading.get_ident(), get_contextvars()))
        bind_contextvars(goal="of this work")

    def waits_again(times: int) -> None:
        wait_until(lambda: len(done) == times and len(loop._idle) == 1, LIMIT, f"the thread waits after {times}")

    given = {1, 2}
    gone = weakref.ref(given)
    loop.in_thread(partial(work, given))
    waits_again(1)
    del given
    assert gone() is None
    loop.in_thread(work)
    waits_again(2)
    assert done == [(done[0][0], {})] * 2
    loop.in_thread(broken)
    wait_until(lambda: not loop._idle, LIMIT, "a bug ends its thread")
    loop.in_thread(work)
    waits_again(3)
    assert done[2] != done[0]


def test_no_more_threads_wait_than_a_limit(two_nodes: tuple[Ros, Ros], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tms_ros.loop.IDLE", 2)
    loop, ends, before = two_nodes[0].loop, [threading.Event() for _ in range(5)], set(threading.enumerate())
    for end in ends:
        loop.in_thread(partial(end.wait, LIMIT))
    for ended, end in enumerate(ends, start=1):
        end.set()
        wait_until(lambda: len(loop._idle) == min(ended, 2), LIMIT, "it waits if no more than one other does")  # noqa: B023
    wait_until(lambda: len(set(threading.enumerate()) - before) == 2, LIMIT, "the others have ended")
