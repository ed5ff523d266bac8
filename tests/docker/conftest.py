"""The fixtures of the container harness."""

import os
import shutil
import subprocess
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from docker_site import DOCKER, IMAGE, Yard
from fleet import Fleet

from conftest import PROJECT

SITE_IMAGE = "tms:site"
collect_ignore = [] if os.environ.get("TMS_FLEET") else ["test_fleet.py"]  # it asks for the whole PC
LONGEST = 1200.0  # s for a script; the first image takes a slow PC 6 minutes, which is not the time of a test


class Engine:
    """The Docker engine: where none answers, one is started."""

    def __init__(self) -> None:
        self.start()

    def start(self) -> None:
        """Start one where none answers."""
        self._pid = script("engine.sh").stdout.strip()  # empty: not ours

    def stop(self) -> None:
        """End it, if it is ours; one that has ended by itself tells why."""
        if self._pid:
            print(script("engine.sh", "stop", self._pid).stderr)


def script(name: str, *words: str, check: bool = True) -> subprocess.CompletedProcess[str]:
    """Run a script of `deploy`."""
    argv = ["sh", str(PROJECT / "deploy" / name), *words]
    done = subprocess.run(
        argv, env={**os.environ, "DOCKER": DOCKER}, capture_output=True, text=True, timeout=LONGEST, check=False
    )
    assert done.returncode == 0 or not check, done.stderr[-2000:]
    return done


@pytest.fixture(scope="session")
def engine() -> Iterator[Engine]:
    """The Docker engine, for the time of the tests."""
    ours = Engine()
    try:
        yield ours
    finally:
        ours.stop()


@pytest.fixture(scope="session")
def image(engine: Engine) -> None:
    """The image with the embedded store, of this checkout."""
    build(engine, IMAGE, "demo")


@pytest.fixture(scope="module")
def site_image(engine: Engine) -> str:
    """The name of the image of a site's PCs, of this checkout."""
    build(engine, SITE_IMAGE, "site")
    return SITE_IMAGE


def build(engine: Engine, name: str, target: str) -> None:
    """Build an image."""
    done = script("image.sh", name, target, check=False)
    if "error during connect" in done.stderr:  # Docker 20.10 may crash as it reads its cache: moby/buildkit#2861
        engine.stop()
        engine.start()
        done = script("image.sh", name, target, check=False)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.fixture(scope="module")
def yard(image: None) -> Iterator[Yard]:
    """A site of four PCs on one network."""
    with running() as site:
        yield site


@pytest.fixture(scope="module")
def yard_apart(image: None) -> Iterator[Yard]:
    """A site of two PCs with a router between them, which passes no multicast."""
    pcs = {"cps": {"roles": ["cps", "sensing"]}, "machine": {"roles": ["machine", "sim"]}}
    with running(pcs=pcs, apart=True, network={"discovery": "server"}) as site:
        yield site


@pytest.fixture(scope="module")
def yard_of_two(image: None) -> Iterator[Yard]:
    """A site whose only machine has a scheduler of its own, on a PC of its own."""
    pcs = {
        "cps": {"roles": ["cps", "sensing"]},
        "machine": {"roles": ["machine", "sim"]},
        "north": {"roles": ["scheduler"], "machines": ["zx200"]},
    }
    with running(pcs=pcs) as site:
        yield site


@pytest.fixture
def fleet(image: None, request: pytest.FixtureRequest) -> Iterator[Fleet]:
    """A site of four PCs with so many machines, which are there as messages only."""
    with running(Fleet, machines=request.param) as site:
        yield site


@contextmanager
def running(kind: type[Yard] = Yard, **changes: Any) -> Iterator[Any]:
    """A site, which is gone afterwards; its logs stay in the folder that TMS_LOGS names."""
    folder = Path(tempfile.mkdtemp(prefix="tms-yard-"))
    folder.chmod(0o755)
    site = kind(uuid.uuid4().hex[:6], folder, **changes)
    try:
        site.create()
        yield site
    finally:
        if logs := os.environ.get("TMS_LOGS"):
            site.keep_logs(Path(logs))
        site.remove()
        shutil.rmtree(folder)
