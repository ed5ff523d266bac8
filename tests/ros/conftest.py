"""What tests of the console process share: it, its site, and a node in the place of everybody else."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from console_process import Console, running, site_of_a_console
from tms_config.config import Site
from tms_ros.node import Ros


@pytest.fixture
def site(tmp_path: Path, own_domain: int) -> Iterator[Site]:
    with site_of_a_console(tmp_path, own_domain) as made:
        yield made


@pytest.fixture
def console(site: Site, tmp_path: Path) -> Iterator[Console]:
    with running(site, tmp_path) as up:
        yield up


@pytest.fixture
def ros(site: Site) -> Iterator[Ros]:
    node = Ros("peers_of_ur")
    yield node
    node.close()
