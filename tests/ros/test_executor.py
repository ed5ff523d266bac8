"""The executor that keeps its wait set: nothing is lost, late, out of order, or executed after its end."""

import threading
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest
from std_msgs.msg import String
from std_srvs.srv import Trigger
from tms_msg_ts.action import LeafNodeBase

from conftest import wait_until
from tms_ros import executor
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = pytest.mark.ros
LIMIT = 20.0  # s
FOR_EVER = 10**13  # ns


@pytest.fixture
def node(two_nodes: tuple[Ros, Ros], monkeypatch: pytest.MonkeyPatch) -> Iterator[Ros]:
    """A node whose executor looks at nothing on its own: what would come late never comes."""
    here, _ = two_nodes
    monkeypatch.setattr(executor, "LONGEST_WAIT", FOR_EVER)
    looked = threading.Event()
    here.on_executor(looked.set)
    assert looked.wait(LIMIT)
    return here


def rounds(node: Ros) -> list[int]:
    """Numbers of coming rounds of the executor, as they begin."""
    found: list[int] = []
    whole = node.loop._executor._run_tasks
    node.loop._executor._run_tasks = lambda: (found.append(len(found)), whole())[1]
    return found


def held(node: Ros) -> threading.Event:
    """Until it is set, the executor waits: what comes meanwhile is ready in one round."""
    begun, go_on = threading.Event(), threading.Event()
    node.on_executor(lambda: (begun.set(), go_on.wait(LIMIT))[0])
    assert begun.wait(LIMIT)
    return go_on


def test_entities_come_and_go_while_it_waits(node: Ros, two_nodes: tuple[Ros, Ros]) -> None:
    _, there = two_nodes
    publisher, heard = there.publisher(String, "/kept"), list[str]()
    for turn in ("one", "two"):
        subscription = node.subscribe(String, "/kept", lambda message: heard.append(message.data), 10)
        wait_until(lambda: publisher.get_subscription_count() == 1, LIMIT, "a reader")
        publisher.publish(String(data=turn))
        wait_until(lambda name=turn: heard[-1:] == [name], LIMIT, "its message")
        node.node.destroy_subscription(subscription)
        wait_until(lambda: publisher.get_subscription_count() == 0, LIMIT, "no reader")
    assert heard == ["one", "two"]


def test_the_wait_set_is_kept_while_no_entity_comes_or_goes(
    node: Ros, two_nodes: tuple[Ros, Ros], monkeypatch: pytest.MonkeyPatch
) -> None:
    _, there = two_nodes
    there.offer(Trigger, "/kept/asked", lambda _, response: response)
    node.prepare(Trigger, "/kept/asked")
    node.call(Trigger, "/kept/asked", Trigger.Request(), LIMIT)
    made, make = list[object](), executor._WaitSet
    monkeypatch.setattr(executor, "_WaitSet", lambda *args: (made.append(args), make(*args))[1])
    for _ in range(10):
        node.call(Trigger, "/kept/asked", Trigger.Request(), LIMIT)
    assert made == []
    node.publisher(String, "/kept/new")
    wait_until(lambda: len(made) > 0, LIMIT, "a new one")


def test_what_others_hear_of_an_action_wakes_no_client_that_waits_for_nothing(
    node: Ros, two_nodes: tuple[Ros, Ros]
) -> None:
    _, there = two_nodes
    there.serve(LeafNodeBase, "/idle/turn", lambda _: (Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)))
    peer, other = node.peer(LeafNodeBase, "/idle/turn"), there.peer(LeafNodeBase, "/idle/turn")
    for one in (peer, other):
        one.wait_ready(LIMIT)
        call = one.send(LeafNodeBase.Goal())
        assert call.wait_for(lambda call=call: call.outcome is Outcome.SUCCEEDED, LIMIT)  # type: ignore[misc]
    wait_until(lambda: node.busy_since() is None, LIMIT, "the round of the last answer is over")
    found = rounds(node)
    for one in (other, other, peer):
        if one is peer:
            assert found == []
        call = one.send(LeafNodeBase.Goal())
        assert call.wait_for(lambda call=call: call.outcome is Outcome.SUCCEEDED, LIMIT)  # type: ignore[misc]


def test_what_a_callback_of_the_same_round_has_ended_is_not_executed(node: Ros, two_nodes: tuple[Ros, Ros]) -> None:
    """Of two timers that end each other, one runs; a subscription comes after all timers."""
    _, there = two_nodes
    publisher, ran = there.publisher(String, "/kept"), set[str]()
    subscription = node.subscribe(String, "/kept", lambda _: ran.add("heard"))
    wait_until(lambda: publisher.get_subscription_count() == 1, LIMIT, "a reader")
    go_on, timers = held(node), dict[str, Any]()

    def due(name: str, end: Callable[[], None]) -> None:
        ran.add(name)
        end()
        node.node.destroy_subscription(subscription)

    for name, other in (("one", "two"), ("two", "one")):
        timers[name] = node.every(0.01, partial(due, name, lambda end=other: node.node.destroy_timer(timers[end])))
    for name, other in (("three", "four"), ("four", "three")):
        timers[name] = node.every(0.01, partial(due, name, lambda end=other: timers[end].cancel()))
    publisher.publish(String(data="waits"))
    there.delivered(publisher, LIMIT)
    wait_until(lambda: all(timer.is_ready() for timer in timers.values()), LIMIT, "all are due")
    go_on.set()
    seen = rounds(node)
    wait_until(lambda: len(seen) > 3, LIMIT, "further rounds")
    assert len(ran & {"one", "two"}) == len(ran & {"three", "four"}) == 1
    assert "heard" not in ran


def test_a_coroutine_goes_on_when_what_it_waits_for_has_come_in_the_same_round(node: Ros) -> None:
    future, went_on = node.create_future(), threading.Event()

    async def waits() -> None:
        await future
        went_on.set()

    go_on = held(node)
    node.start(waits)
    node.on_executor(lambda: future.set_result(None))
    go_on.set()
    assert went_on.wait(LIMIT)


def test_work_that_never_ends_keeps_nothing_else_waiting(node: Ros, two_nodes: tuple[Ros, Ros]) -> None:
    _, there = two_nodes
    there.offer(Trigger, "/kept/asked", lambda _, response: response)
    ended, ticked = threading.Event(), threading.Event()

    async def repeat() -> None:
        if not ended.is_set():
            node.start(repeat)

    node.start(repeat)
    node.every(0.01, ticked.set)
    node.call(Trigger, "/kept/asked", Trigger.Request(), LIMIT)
    assert ticked.wait(LIMIT)
    ended.set()


def test_nothing_is_executed_after_its_end(node: Ros) -> None:
    """Also not what was ready in the round in which it ended."""
    go_on, ran, begun = threading.Event(), list[str](), threading.Event()

    def due(name: str) -> None:
        ran.append(name)
        begun.set()
        go_on.wait(LIMIT)

    first = held(node)
    timers = [node.every(0.01, partial(due, name)) for name in ("one", "two")]
    wait_until(lambda: all(timer.is_ready() for timer in timers), LIMIT, "both are due")
    first.set()
    assert begun.wait(LIMIT)
    node.loop.stop()
    go_on.set()
    node.loop._thread.join(LIMIT)
    assert not node.loop._thread.is_alive() and len(ran) == 1
