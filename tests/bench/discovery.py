"""Fifty participants: how soon a late one knows them all, what they cost while idle, and what they weigh.

Both ways: simple discovery over the loopback interface (the default on one PC) and a Fast DDS discovery server (the
default of containers and of sites with several segments). The floor is the same with one participant.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil

from bench.rig.mesh import Rig, rig
from bench.runner import Figure
from conftest import ports_of

COUNT = 50
SETTLE, WATCH = 5.0, 10.0  # s


def measure() -> Iterable[Figure]:
    with rig() as own:
        alone, _, light = _cost(own, 1)
        found, idle, weight = _cost(own, COUNT)
        yield Figure("late, simple", "ms", found, 1000.0, alone)
        yield Figure("idle, simple", "%", idle, 10.0, 10.0)
        yield Figure("a node, simple", "MB", weight / COUNT, 60.0, light)
        with _server(own):
            alone, _, light = _cost(own, 1)
            found, idle, weight = _cost(own, COUNT)
        yield Figure("late, server", "ms", found, 3000.0, alone)
        yield Figure("idle, server", "%", idle, 10.0, 10.0)
        yield Figure("a node, server", "MB", weight / COUNT, 60.0, light)


def _cost(own: Rig, count: int) -> tuple[float, float, float]:
    """Milliseconds of a late participant, percent of a core of all idle ones, and their MB."""
    with own.beside("fleet", str(count)) as (parent, _):
        time.sleep(SETTLE)
        found = own.bare("find", str(count))[0]
        nodes = psutil.Process(parent).children()
        assert len(nodes) == count
        before, begun = _used(nodes), time.perf_counter()
        time.sleep(WATCH)
        idle = 100 * (_used(nodes) - before) / (time.perf_counter() - begun)
        return found, idle, sum(node.memory_full_info().pss for node in nodes) / 1e6


def _used(nodes: list[psutil.Process]) -> float:
    return sum(sum(node.cpu_times()[:2]) for node in nodes)


@contextmanager
def _server(own: Rig) -> Iterator[None]:
    """A discovery server that everything started meanwhile uses."""
    port = ports_of(own.site.domain) + 80
    program = Path(sys.prefix) / "bin/fast-discovery-server"
    with subprocess.Popen(
        [program, "-i", "0", "-l", "127.0.0.1", "-p", str(port)], stdout=subprocess.DEVNULL
    ) as server:
        os.environ["ROS_DISCOVERY_SERVER"] = f"127.0.0.1:{port}"
        try:
            yield
        finally:
            del os.environ["ROS_DISCOVERY_SERVER"]
            server.kill()
