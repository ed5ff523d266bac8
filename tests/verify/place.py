"""The mesh of the verification, new each time: its command line, a ROS node in it, its store."""

from __future__ import annotations

import json
import os
import re
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pymongo

from conftest import PROJECT, Mesh
from tms_config.config import Site, load_site
from tms_runtime import environment
from verify.truth import Truth

if TYPE_CHECKING:
    from tms_ros.node import Ros

SITE = PROJECT / "configs" / "sites" / "verify.yaml"
STATE = PROJECT / ".state" / "verify"
MACHINE = "zx200"
READY = 90.0  # s for a machine to be re-armed
USUAL = 30.0  # s in which the mesh is ready on a busy PC
CONTROL = re.compile(r"event=control port=(\d+)")


class Place:
    """A running mesh with its machine in the simulator."""

    def __init__(self, mesh: Mesh, site: Site) -> None:
        self.mesh, self.site = mesh, site

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.site.file.ports.console}"

    def json(self, *words: str, expect: int | None = 0) -> Any:
        """What `tms` prints with --json."""
        return json.loads(self.mesh.tms(*words, "--json", expect=expect).stdout)

    def events(self, run: str) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self.json("events", run)
        return found

    def run(self, run: str) -> dict[str, Any]:
        """A run of the history."""
        return next(row for row in self.json("runs") if row["run_id"] == run)

    def arm(self) -> None:
        """Re-arm, as a person does who has looked; again where a stop is still being proven."""
        until(lambda: self.mesh.tms("rearm", MACHINE, "--yes", expect=None).returncode == 0, READY, "re-armed")

    def running(self) -> set[str]:
        """Names of the processes that run."""
        return {row["name"] for row in self.json("ps") if row["state"] == "RUNNING"}

    def truth(self) -> Truth:
        """The machine's true motion."""
        text = (self.mesh.state / "log" / "sim.operasim.log").read_text(encoding="utf-8")
        return Truth(int(CONTROL.findall(text)[-1]), MACHINE)

    @contextmanager
    def store(self) -> Iterator[Any]:
        """The database, as any client of MongoDB sees it."""
        with pymongo.MongoClient("127.0.0.1", self.site.file.ports.store) as client:
            yield client[self.site.file.store.database]

    @contextmanager
    def node(self) -> Iterator[Ros]:
        """A ROS node of this process, as a sensing PC has one."""
        from tms_ros.node import Ros

        ros = Ros("verification")
        try:
            yield ros
        finally:
            ros.close()


@contextmanager
def place() -> Iterator[Place]:
    """The mesh, new, up and armed; nothing of it runs afterwards. Its logs stay."""
    mesh, old = Mesh(SITE, STATE), dict(os.environ)
    mesh.tms("down", expect=None)
    shutil.rmtree(STATE, ignore_errors=True)
    os.environ.pop("ROS_DOMAIN_ID", None)
    os.environ.update(mesh.env)
    try:
        site = load_site()
        environment.enter(site)
        _up(mesh)
        mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / "zx200.yaml"))
        made = Place(mesh, site)
        made.arm()
        yield made
    finally:
        mesh.tms("down", expect=None)
        os.environ.clear()
        os.environ.update(old)


def _up(mesh: Mesh) -> None:
    """Start the mesh.

    The gateway stops its machine when it starts. Where the simulator still goes to its first pose then, a joint may be
    held where it cannot be, and the gateway is not ready: the simulator is started anew, which is printed.
    """
    mesh.tms("up", "--no-wait")
    try:
        until(lambda: mesh.tms("status", expect=None).returncode == 0, USUAL, "the mesh is ready")
    except TimeoutError as error:
        print(f"the simulator is started anew: {error}", flush=True)
        mesh.tms("restart", "sim:operasim")
        mesh.wait_ready()


def until(holds: Any, seconds: float, what: str) -> None:
    """Wait until something holds.

    Raises:
        TimeoutError: it did not.
    """
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            raise TimeoutError(f"not within {seconds:.0f} s: {what}")
        time.sleep(0.02)
