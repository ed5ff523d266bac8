"""What keeps a mesh from starting is said in one line before anything starts."""

import json
import os
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import Mesh, ports_of, site_data, wait_until

pytestmark = pytest.mark.system


@pytest.fixture
def other(domain: int, first_port: int, tmp_path: Path) -> Mesh:
    """A mesh that is not started: same ROS domain as the running one, ports of its own."""
    site = tmp_path / "site.yaml"
    site.write_text(yaml.safe_dump(site_data(domain, first_port + 40, ports={
        "metrics": first_port + 40, "console": first_port + 92, "store": first_port + 93})))  # fmt: skip
    return Mesh(site, tmp_path / "state")


def refusal(mesh: Mesh, *words: str) -> str:
    done = mesh.tms(*words, expect=1)
    assert "Traceback" not in done.stderr + done.stdout
    (line,) = done.stderr.strip().splitlines()
    return line


def test_second_mesh_in_the_same_domain(mesh: Mesh, other: Mesh) -> None:
    line = refusal(other, "up")
    assert "is used by another mesh on this PC" in line and str(mesh.state) in line and "make down" in line
    assert not (other.state / "supervisord.conf").exists()


def test_taken_port(other: Mesh, first_port: int, own_domain: int) -> None:
    data = yaml.safe_load(other.site.read_text())
    other.site.write_text(yaml.safe_dump({**data, "domain": own_domain}))
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", first_port + 41))
        holder.listen()
        line = refusal(other, "up")
    assert f"port {first_port + 41} (metrics of tms:db) is taken by" in line and f"pid {os.getpid()}" in line
    assert not (other.state / "supervisord.conf").exists()


@pytest.fixture
def tiny_disk() -> Iterator[Path]:
    if os.geteuid() != 0:
        pytest.skip("mounting a small disk needs root")
    folder = Path(tempfile.mkdtemp())
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(folder)], check=True)
    yield folder
    subprocess.run(["umount", str(folder)], check=True)
    folder.rmdir()


def test_no_room_for_the_store(other: Mesh, tiny_disk: Path) -> None:
    line = refusal(Mesh(other.site, tiny_disk / "state"), "up")
    assert "MB free, 200.0 MB are needed" in line and "TMS_STATE" in line


def test_state_folder_that_cannot_be_made(other: Mesh, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "cannot be written" in refusal(Mesh(other.site, tmp_path / "file" / "state"), "up")


def test_broken_site_file(other: Mesh) -> None:
    text = other.site.read_text() + "colour: red\n"
    other.site.write_text(text)
    assert refusal(other, "up") == f"tms: {other.site}:{text.count(chr(10))}: colour: unknown key; Correct the file"


def test_without_a_mesh_every_verb_says_how_to_start_it(other: Mesh) -> None:
    for words in (("ps",), ("status",), ("restart", "zx200:rc")):
        assert "Start it: `make up`" in refusal(other, *words)


def test_a_killed_mesh_leaves_no_process_and_starts_again(own_domain: int, tmp_path: Path) -> None:
    """After `kill -9` of supervisord its children end too, and the next `up` finds everything free."""
    site = tmp_path / "site.yaml"
    port = ports_of(own_domain)
    site.write_text(yaml.safe_dump(site_data(own_domain, port, services={"host": {}, "db": {}}, machines={})))
    one = Mesh(site, tmp_path / "state")
    one.tms("up")
    try:
        pids = [row["pid"] for row in json.loads(one.tms("ps", "--json").stdout)]
        os.kill(int((one.state / "supervisord.pid").read_text()), signal.SIGKILL)
        wait_until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in pids), 10, "the children have ended")
        one.tms("up")
    finally:
        one.tms("down")
