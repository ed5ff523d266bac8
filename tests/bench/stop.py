"""From the press of the software stop, and from the kill of a scheduler, to the commands that stop the machines.

Twenty real gateways with a goal each, and both cores busy. Times are taken where they count: the press just before it
is published, the command by the time stamp that DDS gives it when the gateway writes it. The floor of a press is a
plain node that relays one message; of a kill, the lease of 500 ms itself; of a spinning tree, an event that wakes
another thread.
"""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bench.rig.mesh import until
from bench.runner import Figure
from conftest import claimed_domain
from tms_config.config import Site
from tms_config.processes import find
from tms_decision.permit_link import LEASE
from tms_runtime.metrics import unready
from tms_ts.bt import load
from unit.tms_ts.fakes import FakeMachines, FakeWorld

if TYPE_CHECKING:
    from bench.yard.machines import Yard

PRESSES, KILLS, SPINS, RELAYED = 10, 5, 50, 100
RELAY = str(Path(__file__).parent / "yard/relay.py")
HOLDER = str(Path(__file__).parent / "yard/holder.py")
SPIN = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><RetryUntilSuccessful num_attempts="-1"><AlwaysFailure/>'
    "</RetryUntilSuccessful></BehaviorTree></root>"
)


def measure() -> Iterable[Figure]:
    from bench.yard.machines import (
        BURN,
        hurry,
        make_site,
        names,
        process,
    )  # rclpy reads the environment when it is imported

    with ExitStack() as stack:
        domain, folder = stack.enter_context(claimed_domain()), Path(stack.enter_context(tempfile.TemporaryDirectory()))
        site = make_site(folder, domain)
        for name in names():
            log = stack.enter_context((folder / f"{name}.log").open("w"))
            stack.enter_context(process("-m", "tms_runtime.run", f"{name}:rc", stdout=log, stderr=log))
        hurry()
        log = stack.enter_context((folder / "console.log").open("w"))
        console = partial(process, "-m", "tms_runtime.run", "tms:ur", stdout=log, stderr=log)
        yield from _stops(stack, site, process, console, BURN)


def _stops(
    stack: ExitStack, site: Site, process: Callable[..., Any], console: Callable[[], Any], burn: str
) -> Iterator[Figure]:
    from bench.yard.machines import Yard

    yard = Yard(site)
    stack.callback(yard.ros.close)
    yard.arm()
    for command in (("-c", burn), ("-c", burn), (RELAY,)):
        stack.enter_context(process(*command))
    presses = [late for _ in range(PRESSES) for late in _press(yard, yard.press)]
    floor = _relayed(yard)
    yield Figure("press p99", "ms", _p99(presses), 30.0, _p99(floor), usual_floor=20.0)
    yield Figure("spin p99", "ms", _p99([_spin() for _ in range(SPINS)]), 100.0, _p99([_wake() for _ in range(SPINS)]))
    kills = [late for number in range(KILLS) for late in _kill(yard, number + 1, process)]
    yield Figure("kill max", "ms", max(kills), 700.0, LEASE * 1000)
    stack.enter_context(console())
    until(lambda: unready(find(site, "tms:ur")) is None, "the console is there")
    clicks = [late for _ in range(PRESSES) for late in _press(yard, yard.click)]
    yield Figure("press in the console p99", "ms", _p99(clicks), 100.0, _p99(floor), usual_floor=20.0)


def _press(yard: Yard, press: Callable[[], list[float]]) -> list[float]:
    yard.move()
    late = press()
    yard.arm()
    return late


def _kill(yard: Yard, run: int, process: Callable[..., object]) -> list[float]:
    with process(HOLDER, str(run)) as holder:
        yard.wait_moving()
        begun = time.time_ns()
        holder.kill()
        late = yard.stopped_since(begun)
    yard.arm()
    return late


def _relayed(yard: Yard) -> list[float]:
    """ms from a message to the answer of a plain node, many times."""
    from geometry_msgs.msg import Twist
    from std_msgs.msg import Bool

    answered: list[int] = []
    there = threading.Event()

    def received(_zero: Twist, info: dict[str, int]) -> None:
        answered.append(info["source_timestamp"])
        there.set()

    yard.ros.node.create_subscription(Twist, "/bench/zero", received, 1, callback_group=yard.ros.loop.group)
    button = yard.ros.publisher(Bool, "/bench/press", depth=1)
    while not there.wait(0.2):  # until both sides have found each other
        button.publish(Bool())
    late = []
    for _ in range(RELAYED):
        there.clear()
        begun = time.time_ns()
        button.publish(Bool())
        assert there.wait(10.0)
        late.append((answered[-1] - begun) / 1e6)
        time.sleep(0.01)
    return late


def _spin() -> float:
    """ms from the press until a tree that spins in an endless Retry is halted, in the loop that runs use."""
    tree = load(SPIN, world=FakeWorld(FakeMachines()).world())
    pressed, halted = threading.Event(), threading.Event()

    def loop() -> None:
        while not pressed.is_set():
            tree.tick()
        tree.halt()
        halted.set()

    return _until(loop, pressed, halted)


def _wake() -> float:
    """ms from an event until another thread that waits for it has set one."""
    pressed, woken = threading.Event(), threading.Event()

    def loop() -> None:
        pressed.wait()
        woken.set()

    return _until(loop, pressed, woken)


def _until(loop: Callable[[], None], pressed: threading.Event, over: threading.Event) -> float:
    thread = threading.Thread(target=loop, daemon=True)
    thread.start()
    time.sleep(0.05)
    begun = time.perf_counter()
    pressed.set()
    assert over.wait(10.0)
    late = (time.perf_counter() - begun) * 1000
    thread.join()
    return late


def _p99(values: list[float]) -> float:
    return sorted(values)[max(0, -(-99 * len(values) // 100) - 1)]
