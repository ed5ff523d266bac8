"""A real site for plans: one machine at its own speed, on a disk that can stall."""

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from conftest import mesh_apart, running
from power_cut import own_disk

if TYPE_CHECKING:
    from replay.real_site import RealSite

collect_ignore = [] if os.environ.get("TMS_REPLAY") else ["test_replay.py"]  # it takes ten minutes


@pytest.fixture(scope="module")
def real_site(tmp_path_factory: pytest.TempPathFactory) -> "Iterator[RealSite]":
    """A mesh without console and sensing."""
    from replay.real_site import RealSite
    from tms_config.config import load_site
    from tms_ros.node import Ros

    with own_disk(tmp_path_factory.mktemp("replay")) as disk:
        changes = {"sim": {"speed": 1.0}, "services": {"db": {}, "ts": {}, "host": {}}}
        with mesh_apart(disk.folder, **changes) as mesh:
            logs = disk.folder.parent / "ros"
            logs.mkdir()
            mesh.state.mkdir(mode=0o700)
            (mesh.state / "ros").symlink_to(logs)  # rclpy's logs: what writes them must not wait for the disk
            with running(mesh):
                ros = Ros("tms_replay")
                yield RealSite(mesh, load_site(), ros, disk.stalled)
                ros.close()
