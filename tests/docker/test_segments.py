"""A site whose PCs are in segments of their own: the discovery server lets their processes find each other."""

import pytest
from docker_site import Yard

pytestmark = [pytest.mark.docker, pytest.mark.turns, pytest.mark.timeout(400, func_only=True)]


def test_a_task_runs_where_no_multicast_passes(yard_apart: Yard) -> None:
    assert yard_apart.run("1")["outcome"] == "success"


def test_the_discovery_server_comes_back_and_new_processes_find_the_others(yard_apart: Yard) -> None:
    yard_apart.tms("cps", "restart", "tms:discovery")
    yard_apart.tms("machine", "restart", "zx200:rp")
    yard_apart.wait_ready("machine")
    assert yard_apart.run("1")["outcome"] == "success"
