"""Processes of one PC meet, whoever else is there before them."""

import os
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import pytest
import yaml

import programs
from conftest import ports_of, site_data, wait_until
from tms_ros.node import Ros
from tms_runtime.environment import TELLS_FEW

FIRST_FOUR = 4  # participants of DDS on this PC, whom the profile names
NAMES = "tms:host", "tms:ts", "zx200:rc", "zx200:rp"


@contextmanager
def _taken(domain: int) -> Iterator[None]:
    """The ports of the first four, by somebody who never answers: a node in a debugger, one without multicast."""
    with ExitStack() as stack:
        for number in range(FIRST_FOUR):
            taken = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            with suppress(OSError):  # who has it is of another domain
                taken.bind(("127.0.0.1", 7400 + 250 * domain + 10 + 2 * number))
        yield


@pytest.mark.parametrize("silent", [False, True], ids=["nobody else", "the first four never answer"])
def test_all_processes_meet(silent: bool, own_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(own_domain, ports_of(own_domain))))
    for key, value in {"TMS_SITE": str(file), "TMS_STATE": str(tmp_path), "ROS_DOMAIN_ID": str(own_domain)}.items():
        monkeypatch.setenv(key, value)
    with ExitStack() as stack:
        if silent:
            stack.enter_context(_taken(own_domain))
        for name in NAMES:
            running = programs.process(name, dict(os.environ), tmp_path / name)
            stack.callback(running.wait, 20)
            stack.callback(running.terminate)
        for key, value in TELLS_FEW.items():
            monkeypatch.setenv(key, value)
        ros = Ros("late_comer")
        stack.callback(ros.close)
        wanted = {name.replace(":", "_") for name in NAMES}
        wait_until(lambda: wanted <= set(ros.node.get_node_names()), 30, lambda: f"only {ros.node.get_node_names()}")
