"""A site of four PCs as containers on a network of their own, and what can happen to PCs."""

import json
import os
import shutil
import subprocess
import tempfile
import time
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import PROJECT, wait_until

DOCKER = os.environ.get("DOCKER") or "docker"
IMAGE = "tms:harness"
DOMAIN = 42  # the containers' network is their own
READY = 120.0  # s for a container's processes, four containers starting at once on two cores
ADDRESS = "{net}.{host}"
HOSTS = {"cps": 10, "machine": 20, "sensing": 30, "sim": 40}


def docker(*words: str, limit: float = 60, expect: int | None = 0) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([DOCKER, *words], capture_output=True, text=True, timeout=limit, check=False)
    if expect is not None:
        assert done.returncode == expect, f"docker {' '.join(words)}: {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


class Yard:
    """The running site."""

    def __init__(self, run: str, net: str, folder: Path) -> None:
        self.run, self.net, self.folder = run, net, folder
        self.network = f"tms-{run}"

    def name(self, pc: str) -> str:
        return f"tms-{self.run}-{pc}"

    def address(self, pc: str) -> str:
        return ADDRESS.format(net=self.net, host=HOSTS[pc])

    def create(self) -> None:
        """The network, the site file and a container for each PC."""
        docker("network", "create", "--subnet", f"{self.net}.0/24", self.network)
        site = {
            "name": "yard",
            "domain": DOMAIN,
            "sim": {"speed": 3.0},
            "pcs": {pc: {"address": self.address(pc)} for pc in HOSTS},
            "services": {"db": {}, "ts": {}, "ur": {}, "host": {}},
            "machines": {"zx200": {"model": "zx200"}},
        }
        (self.folder / "yard.yaml").write_text(yaml.safe_dump(site, sort_keys=False))
        for pc in HOSTS:
            docker(
                "run", "--detach", "--name", self.name(pc), "--hostname", pc, "--network", self.network,
                "--ip", self.address(pc), "--env", "TMS_SITE=/etc/tms/yard.yaml", "--env", f"TMS_PC={pc}",
                "--volume", f"{self.folder}/yard.yaml:/etc/tms/yard.yaml:ro",
                "--volume", f"{PROJECT}/tests/data:/data:ro", IMAGE,
            )  # fmt: skip
        for pc in HOSTS:
            self.wait_ready(pc)

    def remove(self) -> None:
        """Everything, whatever state it is in."""
        docker("rm", "--force", "--volumes", *(self.name(pc) for pc in HOSTS), expect=None)
        docker("network", "rm", self.network, expect=None)

    def wait_ready(self, pc: str) -> None:
        wait_until(lambda: self.tms(pc, "status", expect=None).returncode == 0, READY, f"{pc}: {self.status(pc)}")

    def status(self, pc: str) -> str:
        done = self.tms(pc, "status", expect=None)
        return done.stdout + done.stderr

    def tms(self, pc: str, *words: str, limit: float = 120, expect: int | None = 0) -> subprocess.CompletedProcess[str]:
        return docker("exec", self.name(pc), "tms", *words, limit=limit, expect=expect)

    def begin(self, task: str) -> subprocess.Popen[str]:
        """`tms run --wait` in the background."""
        words = [DOCKER, "exec", self.name("cps"), "tms", "run", task, "--wait", "--json"]
        return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run(self, task: str) -> dict[str, Any]:
        answer: dict[str, Any] = json.loads(self.tms("cps", "run", task, "--wait", "--json", expect=None).stdout)
        return answer

    def rearm(self) -> None:
        self.tms("cps", "rearm", "zx200", "--yes", expect=None)

    def log(self, pc: str, process: str) -> list[str]:
        file = f"/var/lib/tms/state/log/{process.replace(':', '.')}.log"
        return docker("exec", self.name(pc), "cat", file).stdout.splitlines()

    def in_network_of(self, pc: str, *words: str) -> subprocess.CompletedProcess[str]:
        """A command of this PC in the network namespace of a container: what somebody does to its cable."""
        pid = docker("inspect", "--format", "{{.State.Pid}}", self.name(pc)).stdout.strip()
        done = subprocess.run(
            ["nsenter", "--target", pid, "--net", *words], capture_output=True, text=True, timeout=20, check=False
        )
        return done

    def cable(self, pc: str, *, out: bool) -> None:
        done = self.in_network_of(pc, "ip", "link", "set", "eth0", "down" if out else "up")
        assert done.returncode == 0, done.stderr

    def wait_moving(self) -> None:
        """Until the gateway sees the machine move."""

        wait_until(lambda: self.metric("machine", "zx200:rc", "tms_rc_moving") == 1.0, 60, "the machine moves")

    def metric(self, pc: str, process: str, name: str) -> float | None:
        """A figure of a process, read inside its container; None when it is not there."""
        script = (
            "import sys,urllib.request as u;print(u.urlopen(f'http://{sys.argv[1]}/metrics',timeout=3).read().decode())"
        )
        target = self.targets()[process]
        done = docker("exec", self.name(pc), "python3", "-c", script, target, expect=None)
        found = [line for line in done.stdout.splitlines() if line.startswith((name + " ", name + "{"))]
        return float(found[0].rsplit(" ", 1)[1]) if found else None

    def targets(self) -> dict[str, str]:
        if not hasattr(self, "_targets"):
            rows = json.loads(self.tms("cps", "prometheus", "--json").stdout)["targets"]
            self._targets = {row["labels"]["process"]: row["targets"][0] for row in rows}
        return self._targets


@pytest.fixture(scope="session")
def image() -> None:
    """The image with the embedded store, of this checkout."""
    environment = {**os.environ, "DOCKER": DOCKER, "DOCKER_BUILDKIT": "1"}
    base = subprocess.run(
        ["sh", str(PROJECT / "deploy/base-image.sh")], env=environment, capture_output=True, text=True, check=True
    )
    certificates = Path("/etc/ssl/certs/ca-certificates.crt")
    words = ["build", "--quiet", "--network", "host", "--file", "deploy/Dockerfile", "--target", "demo", "--tag", IMAGE,
             "--build-arg", f"BASE_IMAGE={base.stdout.strip()}",
             *(["--secret", f"id=ca,src={certificates}"] if certificates.exists() else []), "."]  # fmt: skip
    done = subprocess.run([DOCKER, *words], cwd=PROJECT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.fixture(scope="session")
def yard(image: None) -> Iterator[Yard]:
    """The site, with task 1 (a loading cycle) and task 2 (long swings) stored."""
    run = uuid.uuid4().hex[:6]
    folder = Path(tempfile.mkdtemp(prefix="tms-yard-"))
    folder.chmod(0o755)
    site = Yard(run, f"172.31.{int(run[:2], 16)}", folder)
    try:
        site.create()
        site.tms("cps", "param", "load", "configs/parameters/zx200.yaml")
        site.tms("cps", "param", "load", "/data/swings.yaml")
        site.tms("cps", "task", "add", "configs/tasks/one_loading_cycle.xml")
        site.tms("cps", "task", "add", "/data/swings.xml")
        yield site
    finally:
        if os.environ.get("TMS_KEEP") != "1":
            site.remove()
            shutil.rmtree(folder)


def stamp(line: str) -> float:
    """Wall time of a log line, s."""
    text, _, fraction = line.split(" ", 1)[0].partition(".")
    return time.mktime(time.strptime(text, "%Y-%m-%dT%H:%M:%S")) + float(f"0.{fraction}")
