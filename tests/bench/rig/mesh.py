"""A mesh of a benchmark's own, nodes in its domain, and bare processes beside it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import yaml

from conftest import Mesh, claimed_domain, ports_of, site_data
from tms_config.config import Site, load_site
from tms_runtime import environment

if TYPE_CHECKING:
    from tms_ros.node import Ros

BARE = Path(__file__).parent / "bare.py"
LIMIT = 90.0  # s; only bounds a hang


class Rig:
    """A site of the benchmark's own. Everything of it runs in this environment, this process included."""

    def __init__(self, mesh: Mesh, site: Site) -> None:
        self.mesh, self.site = mesh, site

    def bare(self, *words: str) -> list[float]:
        """What a bare process measured, sorted."""
        done = subprocess.run(
            [sys.executable, BARE, *words], stdout=subprocess.PIPE, text=True, timeout=LIMIT, check=True
        )
        return sorted(json.loads(done.stdout))

    @contextmanager
    def beside(self, *words: str) -> Iterator[tuple[int, float]]:
        """A bare process that stays : its pid, and the seconds that it took to be ready."""
        begun = time.perf_counter()
        with subprocess.Popen([sys.executable, BARE, *words], stdout=subprocess.PIPE, text=True) as process:
            try:
                assert process.stdout is not None
                assert process.stdout.readline() == "ready\n"
                yield process.pid, time.perf_counter() - begun
            finally:
                process.kill()

    @contextmanager
    def node(self) -> Iterator[Ros]:
        """A node of this process."""
        from tms_ros.node import Ros

        ros = Ros("bench")
        try:
            yield ros
        finally:
            ros.close()


@contextmanager
def rig(pc: str = "", **changes: object) -> Iterator[Rig]:
    """A site with a domain and ports of its own; its mesh is not up yet, and is down afterwards.

    `pc`: which one this is, of a site of several.
    """
    with claimed_domain() as domain, tempfile.TemporaryDirectory(prefix="tms-bench-") as name:
        folder, old = Path(name), dict(os.environ)
        file = folder / "site.yaml"
        file.write_text(yaml.safe_dump(site_data(domain, ports_of(domain), **changes)))
        mesh = Mesh(file, folder / "state")
        os.environ.update({**mesh.env, "TMS_PC": pc} if pc else mesh.env)
        try:
            site = load_site()
            environment.enter(site)
            yield Rig(mesh, site)
        finally:
            mesh.tms("down", expect=None)
            os.environ.clear()
            os.environ.update(old)


def until(holds: Callable[[], bool], what: str, seconds: float = LIMIT, every: float = 0.02) -> float:
    """Wait for something, and look each `every` [s]; returns how many seconds it took."""
    begun = time.perf_counter()
    while not holds():
        if time.perf_counter() - begun > seconds:
            raise TimeoutError(f"not within {seconds:.0f} s: {what}")
        time.sleep(every)
    return time.perf_counter() - begun


def at(part: float, ordered: list[float]) -> float:
    """A percentile of sorted figures: 0.5 is the median."""
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))]
