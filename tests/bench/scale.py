"""How the scheduler's side of ROS grows with the site, at the level of messages: 10, 50 and 200 subtasks.

The subtasks are bare action servers, a few processes in all; one node of ours, as in tms:ts, has a goal at each,
then cancels them all. The floor of the round trip is the same with 10 subtasks, that of the stop too.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from contextlib import ExitStack

from tms_msg_ts.action import LeafNodeBase

from bench.rig.mesh import Rig, at, rig, until
from bench.runner import Figure
from tms_core.ros import Outcome, Peer, Ros

SIZES = (10, 50, 200)
A_PROCESS = 50  # action servers in one process
LIMIT = 30.0  # s


def measure() -> Iterable[Figure]:
    with rig() as own:
        cost = {size: _cost(own, size) for size in SIZES}
    small = cost[SIZES[0]]
    for size in SIZES:
        accepted, stopped = cost[size]
        yield Figure(f"accepted, {size}", "ms", accepted, 25.0, small[0], usual_floor=10.0)
        yield Figure(f"a stop, {size}", "ms", stopped / size, 5.0, small[1] / SIZES[0], usual_floor=5.0)


def _cost(own: Rig, size: int) -> tuple[float, float]:
    """Milliseconds until one goal is accepted (median, the others running), and until all of them are cancelled."""
    with ExitStack() as stack:
        for first in range(0, size, A_PROCESS):
            stack.enter_context(own.beside("crowd", str(first), str(min(A_PROCESS, size - first))))
        ros = stack.enter_context(own.node())
        peers = [ros.peer(LeafNodeBase, f"/crowd_{number}/act") for number in range(size)]
        until(lambda: all(peer.ready() for peer in peers), f"{size} action servers found", LIMIT)
        return _measure(ros, peers)


def _measure(ros: Ros, peers: list[Peer]) -> tuple[float, float]:
    calls, times = [], []
    for peer in peers:
        begun = time.perf_counter()
        call = peer.send(LeafNodeBase.Goal())
        assert call.wait_for(lambda call=call: call.accepted, LIMIT), "a goal was not accepted"  # type: ignore[misc]
        times.append((time.perf_counter() - begun) * 1000)
        calls.append((peer, call))
    begun = time.perf_counter()
    for peer, call in calls:
        peer.cancel(call)
    for _, call in calls:
        assert call.wait_for(lambda call=call: call.outcome is not None, LIMIT), "a cancel got lost"  # type: ignore[misc]
        assert call.outcome is Outcome.CANCELED
    return at(0.5, sorted(times)), (time.perf_counter() - begun) * 1000
