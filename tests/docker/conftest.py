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

from conftest import PROJECT


@pytest.fixture(scope="session")
def image() -> None:
    """The image with the embedded store, of this checkout."""
    argv = ["sh", str(PROJECT / "deploy/image.sh"), IMAGE, "demo"]
    done = subprocess.run(argv, env={**os.environ, "DOCKER": DOCKER}, capture_output=True, text=True, check=False)
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


@contextmanager
def running(**changes: Any) -> Iterator[Yard]:
    """A site, which is gone afterwards; its logs stay in the folder that TMS_LOGS names."""
    folder = Path(tempfile.mkdtemp(prefix="tms-yard-"))
    folder.chmod(0o755)
    site = Yard(uuid.uuid4().hex[:6], folder, **changes)
    try:
        site.create()
        yield site
    finally:
        if logs := os.environ.get("TMS_LOGS"):
            site.keep_logs(Path(logs))
        site.remove()
        shutil.rmtree(folder)
