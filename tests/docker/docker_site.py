"""A site of several PCs as containers, and what can happen to PCs, cables and networks."""

import calendar
import json
import os
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from conftest import PROJECT, wait_until
from prometheus_server import get
from tms_config.config import load_site
from tms_config.processes import Process, table
from tms_reason.reason import Reason
from tms_runtime import metrics

DOCKER = os.environ.get("DOCKER") or "docker"
IMAGE = "tms:harness"
DOMAIN = 42  # the containers' networks are their own
READY = 120.0  # s for a container's processes, four containers starting at once on two cores
FOUR_PCS: dict[str, dict[str, Any]] = {"cps": {}, "machine": {}, "sensing": {}, "sim": {}}
LOOK = 0.2  # s between looks that cost the processes something
RANGE = "172.31.0.0/16"  # where the networks of the tests are


def docker(*argv: str, limit: float = 60, expect: int | None = 0) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([DOCKER, *argv], capture_output=True, text=True, timeout=limit, check=False)
    if expect is not None:
        assert done.returncode == expect, f"docker {' '.join(argv)}: {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def host(*argv: str) -> None:
    """A command on the PC that the containers run on."""
    done = subprocess.run(argv, capture_output=True, text=True, timeout=20, check=False)
    assert done.returncode == 0, f"{argv}: {done.stderr}"


class Yard:
    """A running site. `apart`: every PC in a segment of its own, with a router between them."""

    def __init__(
        self, run: str, folder: Path, pcs: dict[str, dict[str, Any]] = FOUR_PCS, *, apart: bool = False, **changes: Any
    ) -> None:
        self._run, self._folder, self.apart = run, folder, apart
        first = int(run[:2], 16) & 0xF0
        self.address = {
            pc: f"172.31.{first + i}.10" if apart else f"172.31.{first}.{10 * i + 10}" for i, pc in enumerate(pcs)
        }
        site = {
            "name": "yard",
            "domain": DOMAIN,
            "sim": {"speed": 3.0},
            "pcs": {pc: {"address": self.address[pc], **facts} for pc, facts in pcs.items()},
            "services": {"db": {}, "ts": {}, "ur": {}, "sp": {"role": "sensing"}, "host": {}},
            "machines": {"zx200": {"model": "zx200"}},
            **changes,
        }
        file = folder / "yard.yaml"
        file.write_text(yaml.safe_dump(site, sort_keys=False))
        self.rows = table(load_site(str(file)))

    def name(self, pc: str) -> str:
        return f"tms-{self._run}-{pc}"

    def network(self, pc: str) -> str:
        return f"tms-{self._run}-{self.address[pc].split('.')[2]}"

    def create(self) -> None:
        """The networks and a container for each PC; the tasks are 1 (a loading cycle) and 2 (swings)."""
        self.start()
        if "zx200" in {row.machine for row in self.rows}:
            self.tms("cps", "rearm", "zx200", "--yes")
        self.tms("cps", "param", "load", "configs/parameters/zx200.yaml")
        self.tms("cps", "param", "load", "/data/swings.yaml")
        self.tms("cps", "task", "add", "configs/tasks/one_loading_cycle.xml")
        self.tms("cps", "task", "add", "/data/swings.xml")

    def start(self) -> None:
        """The networks and a container for each PC, until all are ready."""
        for pc in {self.network(pc): pc for pc in self.address}.values():
            subnet = self.address[pc].rpartition(".")[0] + ".0/24"
            plain = ["--opt", "com.docker.network.bridge.enable_ip_masquerade=false"]  # a router, no translation
            docker("network", "create", "--subnet", subnet, *plain, self.network(pc))
        if self.apart:
            host("iptables", "-I", "DOCKER-USER", "-s", RANGE, "-d", RANGE, "-j", "ACCEPT")
        for pc in self.address:
            self._start(pc)
        for pc in self.address:
            self.wait_ready(pc)

    def _start(self, pc: str, options: Sequence[str] = (), words: Sequence[str] = ()) -> None:
        docker(
            "run", "--detach", "--name", self.name(pc), "--hostname", pc, "--network", self.network(pc),
            "--ip", self.address[pc], "--env", "TMS_SITE=/etc/tms/yard.yaml", "--env", f"TMS_PC={pc}",
            "--volume", f"{self._folder}/yard.yaml:/etc/tms/yard.yaml:ro",
            "--volume", f"{PROJECT}/tests/data:/data:ro", "--volume", f"{PROJECT}/tests/docker:/tools:ro",
            *options, IMAGE, *words,
        )  # fmt: skip

    def remove(self) -> None:
        """Everything, whatever state it is in."""
        docker("rm", "--force", "--volumes", *(self.name(pc) for pc in self.address), expect=None)
        docker("network", "rm", *{self.network(pc) for pc in self.address}, expect=None)
        if self.apart:
            host("iptables", "-D", "DOCKER-USER", "-s", RANGE, "-d", RANGE, "-j", "ACCEPT")

    def keep_logs(self, folder: Path) -> None:
        """Copy what all processes wrote."""
        for pc in self.address:
            (folder / self.name(pc)).mkdir(parents=True, exist_ok=True)
            docker("cp", f"{self.name(pc)}:/var/lib/tms/state/log/.", str(folder / self.name(pc)), expect=None)

    def wait_ready(self, pc: str) -> None:
        """Until every process of a PC that starts by itself can work."""
        waiting: dict[Process, Reason | None] = {
            row: None for row in self.rows if row.pc == pc and row.autostart and row.ours
        }

        def ready() -> bool:
            for row in list(waiting):
                waiting[row] = metrics.unready(row)
                if waiting[row] is None:
                    del waiting[row]
            return not waiting

        try:
            wait_until(ready, READY, f"{pc} is ready", LOOK)
        except AssertionError:
            print(docker("logs", "--tail", "30", self.name(pc)).stdout, waiting)
            raise

    def tms(self, pc: str, *argv: str, limit: float = 120, expect: int | None = 0) -> subprocess.CompletedProcess[str]:
        return docker("exec", self.name(pc), "tms", *argv, limit=limit, expect=expect)

    def begin(self, task: str) -> subprocess.Popen[str]:
        """`tms run --wait` in the background."""
        argv = [DOCKER, "exec", self.name("cps"), "tms", "run", task, "--wait", "--json"]
        return subprocess.Popen(argv, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run(self, task: str) -> dict[str, Any]:
        done = self.tms("cps", "run", task, "--wait", "--json", expect=None)
        answer: dict[str, Any] = json.loads(done.stdout) if done.stdout else {"outcome": done.stderr}
        return answer

    def rearm(self) -> None:
        self.tms("cps", "rearm", "zx200", "--yes", expect=None)

    def log(self, pc: str, process: str) -> list[str]:
        file = f"/var/lib/tms/state/log/{process.replace(':', '.')}.log"
        return docker("exec", self.name(pc), "cat", file).stdout.splitlines()

    def stops(self) -> list[str]:
        """What the gateway's log tells of its stops."""
        return [line for line in self.log("machine", "zx200:rc") if "event=stop " in line]

    def pid(self, pc: str) -> int:
        """First process of a container; without it the container is dead, as a PC without power."""
        return int(docker("inspect", "--format", "{{.State.Pid}}", self.name(pc)).stdout)

    def wait_moving(self) -> None:
        """Until the gateway sees the machine move."""
        wait_until(lambda: self.metric("zx200:rc", "tms_rc_moving") == 1.0, 60, "the machine moves", LOOK)

    def metric(self, process: str, name: str) -> float | None:
        """A figure of a process; None when it does not answer."""
        row = next(row for row in self.rows if row.full == process)
        try:
            page = get(f"http://{row.address}:{row.port}/metrics")
        except OSError:
            return None
        found = [line for line in page.splitlines() if line.startswith((name + " ", name + "{"))]
        return float(found[0].rsplit(" ", 1)[1]) if found else None


def in_network_of(pid: int, *argv: str) -> subprocess.CompletedProcess[str]:
    """A command of this PC in the network namespace of a container: what somebody does to its cable."""
    argv = ("nsenter", "--target", str(pid), "--net", *argv)
    return subprocess.run(argv, capture_output=True, text=True, timeout=20, check=False)


def cable(pid: int, *, out: bool) -> None:
    done = in_network_of(pid, "ip", "link", "set", "eth0", "down" if out else "up")
    assert done.returncode == 0, done.stderr


def stamp(line: str) -> float:
    """Wall time of a container's log line, s; its clock is the host's, its zone UTC."""
    text, _, fraction = line.split(" ", 1)[0].partition(".")
    return calendar.timegm(time.strptime(text, "%Y-%m-%dT%H:%M:%S")) + float(f"0.{fraction}")


def commanded(line: str) -> float:
    """When the stop of a receipt was commanded, s of wall time; `seconds` of it is how long the machine took."""
    return stamp(line) - float(line.split(" seconds=")[1].split()[0])
