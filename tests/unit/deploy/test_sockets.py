"""`deploy/sockets.sh` gives sockets the room that the DDS profile asks for, and takes none away."""

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import PROJECT

WANTED = dict(re.findall(r"^(\S+) = (\d+)$", (PROJECT / "deploy/network/sockets.conf").read_text(), re.MULTILINE))
RECEIVED, SENT = "net.core.rmem_max", "net.core.wmem_max"
READ_ONLY = Path("/proc/sys/kernel/ngroups_max")  # 65536, also for root
Run = Callable[..., str]


def at(kernel: Path, name: str) -> Path:
    return kernel / name.replace(".", "/")


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run the script over a kernel that is made up; what it tells."""
    at(tmp_path, SENT).parent.mkdir(parents=True)

    def script(*argv: str) -> str:
        command = ["/bin/sh", str(PROJECT / "deploy/sockets.sh"), *argv]
        surroundings = {"KERNEL": str(tmp_path), "PATH": "/usr/bin:/bin"}
        done = subprocess.run(command, env=surroundings, capture_output=True, text=True, timeout=30, check=False)
        assert done.returncode == 0
        return done.stdout + done.stderr

    return script


def test_the_file_asks_for_what_the_profile_asks_for() -> None:
    profile = (PROJECT / "deploy/dds/loopback.xml").read_text()
    sizes = dict(re.findall(r"<(send|receive)BufferSize>(\d+)<", profile))
    assert {RECEIVED: sizes["receive"], SENT: sizes["send"]} == WANTED


def test_small_limits_are_raised_and_large_ones_stay(run: Run, tmp_path: Path) -> None:
    at(tmp_path, RECEIVED).write_text("2147483647\n")
    at(tmp_path, SENT).write_text("212992\n")
    assert run() == f"until this PC starts anew: {SENT}={WANTED[SENT]}\n"
    assert at(tmp_path, RECEIVED).read_text() == "2147483647\n"
    assert at(tmp_path, SENT).read_text() == f"{WANTED[SENT]}\n"
    assert run() == ""


def test_who_may_not_is_told_the_command(run: Run, tmp_path: Path) -> None:
    at(tmp_path, SENT).symlink_to(READ_ONLY)
    (line,) = run().splitlines()
    assert line.endswith(f"sudo sysctl -w {SENT}={WANTED[SENT]}")
    assert run("quiet") == ""


def test_a_container_that_is_shown_no_limits_says_nothing(run: Run) -> None:
    assert run() == ""
