"""Fifty participants: how soon a late one knows them all, what they cost while idle, and what they weigh.

Both ways: simple discovery over the loopback interface (the default on one PC) and a Fast DDS discovery server (the
default of containers and of sites with several segments). The late one is a node of ours, its floor a bare rclpy node;
the other floors are the same with one participant.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil

from bench.rig.costs import pss
from bench.rig.mesh import LIMIT, Rig, rig
from bench.runner import Figure
from conftest import ports_of

COUNT = 50
SETTLE, WATCH = 3.0, 6.0  # s
LATE = Path(__file__).parent / "rig/late.py"


@dataclass(frozen=True)
class Cost:
    """Of a number of participants."""

    late: float  # ms until a node of ours that comes later knows them all
    bare: float  # ms, a bare one
    idle: float  # % of a core, all of them
    memory: float  # MB (PSS) of one


def measure() -> Iterable[Figure]:
    with rig() as own:
        yield from _figures("simple", _cost(own, 1), _cost(own, COUNT), late_limit=1000.0)
        with _server(own) as pid:
            alone, many = _cost(own, 1), _cost(own, COUNT)
            memory = pss(pid)
        yield from _figures("server", alone, many, late_limit=3000.0, note=f"the server itself has {memory:.0f} MB")


def _figures(way: str, alone: Cost, many: Cost, late_limit: float, note: str = "") -> Iterable[Figure]:
    yield Figure(f"{way}: a late one knows {COUNT}", "ms", many.late, late_limit, many.bare)
    yield Figure(f"{way}: idle, {COUNT} together", "% core", many.idle, 10.0, max(COUNT * alone.idle, 0.01))
    yield Figure(f"{way}: memory (PSS) of one", "MB", many.memory, 60.0, alone.memory, note=note)


def _cost(own: Rig, count: int) -> Cost:
    with own.beside("fleet", str(count)) as (parent, _):
        time.sleep(SETTLE)
        bare, late = own.bare("find", str(count))[0], _late(count)
        nodes = psutil.Process(parent).children()
        assert len(nodes) == count
        before, begun = _used(nodes), time.perf_counter()
        time.sleep(WATCH)
        idle = 100 * (_used(nodes) - before) / (time.perf_counter() - begun)
        return Cost(late, bare, idle, sum(node.memory_full_info().pss for node in nodes) / 1e6 / count)


def _late(count: int) -> float:
    words = [sys.executable, str(LATE), str(count)]
    return float(subprocess.run(words, stdout=subprocess.PIPE, text=True, timeout=LIMIT, check=True).stdout)


def _used(nodes: list[psutil.Process]) -> float:
    return sum(sum(node.cpu_times()[:2]) for node in nodes)


@contextmanager
def _server(own: Rig) -> Iterator[int]:
    """A discovery server that everything started meanwhile uses, as processes of such a site do; its pid."""
    port = ports_of(own.site.domain) + 80
    program = Path(sys.prefix) / "bin/fast-discovery-server"
    with subprocess.Popen(
        [program, "-i", "0", "-l", "127.0.0.1", "-p", str(port)], stdout=subprocess.DEVNULL
    ) as server:
        os.environ.update({"ROS_DISCOVERY_SERVER": f"127.0.0.1:{port}", "ROS_SUPER_CLIENT": "TRUE"})
        try:
            yield server.pid
        finally:
            del os.environ["ROS_DISCOVERY_SERVER"], os.environ["ROS_SUPER_CLIENT"]
            server.kill()
