"""A few processes of a mesh, started one by one without supervisord, and a client of them."""

import os
import subprocess
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import pytest
from tms_msg_db.srv import ListTasks

import programs
from conftest import ports_of, wait_until
from tms_config.config import PROJECT, Site, load_site
from tms_config.processes import find
from tms_reason.errors import RosError
from tms_ros.node import Ros
from tms_runtime import environment

M = TypeVar("M", bound="Mesh")
LIMIT = 60.0  # s for whatever must happen at all
SITE = """
name: dbtest
domain: {domain}
ports: {{metrics: {metrics}, console: {console}, store: {store}}}
services: {{db: {{role: cps}}, sp: {{role: cps}}}}
sensing: sensing.yaml
machines: {{}}
"""


class Mesh:
    """`tms:store` and `tms:db` as processes of our own, and a client of them."""

    SITE = SITE

    def __init__(self, folder: Path, domain: int) -> None:
        port = ports_of(domain)
        file = folder / "site.yaml"
        text = self.SITE.format(domain=domain, metrics=port, console=port + 90, store=port + 91)
        file.write_text(text)
        self.site: Site = load_site(str(file))
        self.environment = {**os.environ, **environment.environment(self.site)}
        self._running: dict[str, programs.Program] = {}
        self.log = folder / "log.txt"
        self.ros: Ros = Ros("client")

    def start(self, name: str) -> None:
        self._running[name] = programs.process(name, self.environment, self.log)

    def kill(self, name: str) -> None:
        self._running[name].kill()
        self._running.pop(name).wait(10)

    def close(self) -> None:
        self.ros.close()
        for process in self._running.values():
            process.terminate()
        for process in self._running.values():
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait(30)

    def call(self, service: Any, name: str, /, **fields: Any) -> Any:
        return self.ros.call(service, name, service.Request(**fields), LIMIT)

    def db(self, service: Any, name: str, /, **fields: Any) -> Any:
        return self.call(service, f"/tms/db/{name}", **fields)

    def ready(self) -> tuple[int, str]:
        url = f"http://127.0.0.1:{find(self.site, 'tms:db').port}/readyz"
        try:
            with urllib.request.urlopen(url, timeout=5) as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read().decode()
        except urllib.error.URLError:
            return 0, "no answer"

    def wait_ready(self) -> None:
        self.until(lambda: self.ready()[0] == 200, "/readyz 200")
        self.until(self._answers, "answer")

    def _answers(self) -> bool:
        """A request may still go to a killed predecessor, until discovery has dropped it."""
        try:
            self.ros.call(ListTasks, "/tms/db/list_tasks", ListTasks.Request(), 1.0)
        except RosError:
            return False
        return True

    def wait_away(self) -> None:
        self.until(lambda: self.ready()[0] == 503 and "STORE_DOWN" in self.ready()[1], "/readyz 503")

    def until(self, there: Callable[[], bool], what: str) -> None:
        wait_until(there, LIMIT, lambda: f"{what}\n{self.log.read_text()}")


def bare(folder: Path, domain: int, kind: type[M]) -> Iterator[M]:
    """A mesh where nothing runs yet; ends what the test started."""
    if not (PROJECT / ".venv-store" / "bin" / "secantusd-py").exists():
        pytest.fail("no real store here: `make setup` installs it")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        patch.delenv("TMS_MONGODB_URI", raising=False)
        for key, value in environment.environment(load_site()).items():
            patch.setenv(key, value)
        mesh = kind(folder, domain)
        try:
            yield mesh
        finally:
            mesh.close()
