"""The stand-in of OperaSim-PhysX, the bridge, other processes of ours, and a ROS node of somebody else."""

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import yaml

import programs
from conftest import PROJECT, wait_until
from programs import Program
from tms_cli.drill.operasim import ControlPort
from tms_config.config import load_site
from tms_ros.node import Ros
from tms_runtime import environment
from tms_runtime.priority import come_first

LIMIT = 40.0  # s for whatever must happen at all
PLACE = [-13.85, -9.17, 1.68]  # m, where SimpleScene has its zx200


class OperaSim:
    """A site with one machine in the simulator. Its name must be one of its own: other tests share the domain."""

    def __init__(self, folder: Path, domain: int, port: int, machine: str, model: str) -> None:
        """`port` is the first of some that are free."""
        self.machine = machine
        file, scene = folder / "site.yaml", folder / "scene.yaml"
        bridge = {"port": port + 30, "clock": True}
        site = {"name": "operasimtest", "domain": domain, "backend": "physx", "ports": {"metrics": port}}
        file.write_text(yaml.safe_dump({**site, "services": {"if": bridge}, "machines": {machine: {"model": model}}}))
        machines = {machine: {"model": model, "place": PLACE}, "c30r": {"model": "c30r", "place": [0, 0, 0]}}
        scene.write_text(yaml.safe_dump({"machines": machines}))
        loaded = load_site(str(file))
        self.border = loaded.border(machine)
        self._env = {**os.environ, **environment.environment(loaded)}
        self._folder, self._log = folder, folder / "operasim.log"
        self._processes: dict[str, Program] = {}
        self.run("tms:if")
        words = ["-m", "operasim", "--scene", str(scene), "--port", str(port + 30), "--control-port", "0"]
        with self._log.open("w") as out:
            self.simulator = subprocess.Popen([sys.executable, *words], cwd=PROJECT / "tests", stdout=out, stderr=out)
        come_first(-12, {self.simulator.pid}, realtime=3)  # it is a machine, which no PC can keep from its motions
        self.ros = Ros("operasim_test")
        self.until(lambda: "event=control" in self.log, "the control port")
        (control,) = re.findall(r"event=control port=(\d+)", self.log)
        self._control = ControlPort(int(control), LIMIT)
        self.command = self._control.command

    def run(self, *names: str) -> None:
        """Start processes of ours."""
        for name in names:
            self._processes[name] = programs.process(name, self._env, self._log_of(name))

    def process(self, name: str) -> Program:
        """A process of ours that runs."""
        return self._processes[name]

    def kill(self, name: str) -> None:
        """Kill a process of ours."""
        self._processes.pop(name).kill()

    def _log_of(self, process: str) -> Path:
        return self._folder / f"{process.replace(':', '_')}.log"

    @property
    def log(self) -> str:
        """What the simulator has said so far."""
        return self._log.read_text()

    def until(self, holds: Callable[[], Any], what: str, limit: float = LIMIT) -> None:
        def told() -> str:
            return "\n".join((what, self.log, *(self._log_of(name).read_text() for name in self._processes)))

        wait_until(lambda: bool(holds()), limit, told)

    def truth(self) -> dict[str, Any]:
        found = self.command("state")["machines"][self.machine]
        assert isinstance(found, dict)
        return found

    def stands(self) -> bool:
        """Whether no joint moves, some time after the start, when all of them begin to."""
        joints = self.truth()["joints"].values()
        still = all(joint is None or abs(joint["velocity"]) < 1e-3 for joint in joints)
        return still and self.command("state")["time"] > 1.0

    def joint(self, name: str) -> dict[str, float]:
        found = self.truth()["joints"][name]
        assert isinstance(found, dict)
        return found

    def hear(self, kind: Any, topic: str) -> list[Any]:
        found: list[Any] = []
        self.ros.subscribe(kind, f"/{self.machine}/{topic}", found.append, depth=10)
        return found

    def speaker(self, kind: Any, topic: str) -> Any:
        publisher = self.ros.publisher(kind, f"/{self.machine}/{topic}")
        self.until(lambda: publisher.get_subscription_count() > 0, f"the bridge hears {topic}")
        return publisher

    def close(self) -> None:
        self._control.close()
        running: dict[str, Any] = {"simulator": self.simulator, **self._processes}
        for process in running.values():
            process.terminate()
        try:
            codes = {name: process.wait(10) for name, process in running.items()}
            assert not any(codes.values()), (codes, self.log)
        finally:
            for process in running.values():
                process.kill()
            self.ros.close()


@contextmanager
def operasim(folder: Path, domain: int, port: int, machine: str, model: str) -> Iterator[OperaSim]:
    """A site of its own, which ends with the block; `port` is the first of some that are free."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        made = OperaSim(folder, domain, port, machine, model)
        try:
            yield made
        finally:
            made.close()
