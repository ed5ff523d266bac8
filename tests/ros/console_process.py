"""The console process of a site of its own, and a ROS node beside it."""

import json
import os
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import forked
import programs
from conftest import ports_of, wait_until
from tms_config.config import Site, load_site
from tms_config.processes import find
from tms_runtime import environment

LIMIT = 60.0  # s for whatever must happen at all
SITE = """
name: urtest
domain: {domain}
ports: {{metrics: {metrics}, console: {console}}}
services: {{ur: {{role: cps}}}}
machines: {{zx200: {{model: zx200}}}}
"""


@dataclass
class Console:
    """The process and its address."""

    site: Site
    process: programs.Program
    log: Path

    def ask(self, path: str, body: Any = None, **headers: str) -> tuple[int, Any]:
        data = None if body is None else json.dumps(body).encode()
        url = f"http://127.0.0.1:{self.site.file.ports.console}{path}"
        request = urllib.request.Request(url, data, {"Content-Type": "application/json", **headers})
        try:
            with urllib.request.urlopen(request, timeout=LIMIT) as answer:
                return answer.status, json.loads(answer.read())
        except urllib.error.HTTPError as error:
            with error:
                return error.code, json.loads(error.read())

    def get(self, path: str) -> Any:
        status, answer = self.ask(path)
        assert status == 200, answer
        return answer

    def ready(self) -> bool:
        assert self.process.returncode is None, self.log.read_text()
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{find(self.site, 'tms:ur').port}/readyz", timeout=5):
                return True
        except urllib.error.URLError:
            return False


def spawn(site: Site, log: Path, become: Callable[..., None] = forked.be_process) -> programs.Program:
    return programs.process("tms:ur", {**os.environ, **environment.environment(site)}, log, become)


@contextmanager
def site_of_a_console(tmp_path: Path, domain: int) -> Iterator[Site]:
    """A site of our own, and its environment for the ROS node of the test."""
    file = tmp_path / "site.yaml"
    port = ports_of(domain)
    file.write_text(SITE.format(domain=domain, metrics=port, console=port + 90))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(tmp_path / "state"))
        site = load_site(str(file))
        for key, value in environment.environment(site).items():
            patch.setenv(key, value)
        yield site


@contextmanager
def running(site: Site, tmp_path: Path, become: Callable[..., None] = forked.be_process) -> Iterator[Console]:
    """The console's process, up; it is killed afterwards."""
    console = Console(site, spawn(site, tmp_path / "log.txt", become), tmp_path / "log.txt")
    try:
        wait_until(console.ready, LIMIT, "/readyz 200")
        yield console
    finally:
        console.process.kill()
        console.process.wait(10)
