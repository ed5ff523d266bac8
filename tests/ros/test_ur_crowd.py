"""A stop goes through while a thousand connections hang, and viewers stay; with the real console process."""

import socket
import ssl
import subprocess
import threading
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import StopMachine

import forked
from conftest import wait_until
from console_process import LIMIT, Console, running
from hanging import hanging, still_open
from tms_config.config import Site, load_site
from tms_config.processes import find
from tms_ros.node import Ros

pytestmark = [pytest.mark.turns, pytest.mark.ros]
MANY = 1000


@pytest.fixture
def stops(ros: Ros) -> list[str]:
    """Causes of the stops that reached the machine's gateway."""
    received: list[str] = []

    def stop(request: Any, response: Any) -> Any:
        received.append(request.cause)
        response.receipt = StopReceipt(machine="zx200", confirmed=True, cause=request.cause)
        return response

    ros.offer(StopMachine, "/zx200/rc/stop", stop)
    return received


@pytest.fixture
def patient(site: Site, tmp_path: Path) -> Iterator[Console]:
    """A console that closes nothing for the time that it hangs: what is answered has not waited for that."""
    with running(site, tmp_path, forked.be_patient_console) as up:
        yield up


@pytest.mark.parametrize("source", ["127.0.0.1", "127.0.0.9"])
def test_a_stop_beside_a_thousand_hanging_connections(
    patient: Console,
    stops: list[str],
    source: str,
) -> None:
    """However long they hang. How soon it does is a figure of `make bench ONLY=console`."""
    wait_until(lambda: patient.ask("/api/stop", {})[1][0]["confirmed"], LIMIT, "the gateway is there")
    stops.clear()
    with hanging(patient.site.file.ports.console, MANY, source):
        for _ in range(3):
            status, receipts = patient.ask("/api/stop", {"machine": "zx200"})
            assert (status, receipts[0]["confirmed"]) == (200, True)
        assert len(stops) == 3
        assert psutil.Process(patient.process.pid).num_fds() < 1024
    assert "Traceback" not in patient.log.read_text()
    assert "out of system resource" not in patient.log.read_text()


def test_all_are_answered_once_slow_readers_are_closed(console: Console) -> None:
    with hanging(console.site.file.ports.console, MANY):
        wait_until(lambda: console.ask("/api/state")[0] == 200, LIMIT, "an answer")


def test_what_hangs_is_closed_and_viewers_are_not(console: Console) -> None:
    port = console.site.file.ports.console
    with socket.create_connection(("127.0.0.1", port), LIMIT) as viewer:
        viewer.sendall(f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        seen = threading.Event()
        gone = threading.Event()

        def look() -> None:
            while data := viewer.recv(65536):
                if b"event: state" in data:
                    seen.set()
            gone.set()

        threading.Thread(target=look, daemon=True).start()
        assert seen.wait(LIMIT)
        with hanging(port, MANY) as opened:
            wait_until(lambda: still_open(opened) <= 64, LIMIT, "as many as one address may have")
            wait_until(lambda: still_open(opened) == 0, LIMIT, "all time-outs")
            seen.clear()
            assert seen.wait(LIMIT)
            assert not gone.is_set()
        viewer.shutdown(socket.SHUT_RDWR)
        assert gone.wait(LIMIT)


def test_readers_of_nothing_are_closed(console: Console) -> None:
    with hanging(console.site.file.ports.console, 40):
        wait_until(lambda: cut(console, "slow_reader") > 0, LIMIT, "a slow reader is closed")
        wait_until(lambda: cut(console, "headers") > 0 and cut(console, "body") > 0, LIMIT, "so are the others")


@pytest.fixture
def encrypted(site: Site, tmp_path: Path) -> Site:
    """The site with its console behind TLS, where the web server hears nothing of a connection before its handshake."""
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost",
         "-keyout", str(tmp_path / "key.pem"), "-out", str(tmp_path / "cert.pem")], check=True, capture_output=True,
    )  # fmt: skip
    with site.path.open("a") as file:
        file.write("console: {tls: {certificate: cert.pem, key: key.pem}}\n")
    return load_site(str(site.path))


def test_a_page_is_answered_beside_handshakes_that_hang(encrypted: Site, tmp_path: Path) -> None:
    with running(encrypted, tmp_path, forked.be_patient_console) as console:
        ours = ssl.create_default_context(cafile=str(tmp_path / "cert.pem"))
        port = encrypted.file.ports.console
        with hanging(port, MANY):
            with urllib.request.urlopen(f"https://localhost:{port}/", timeout=LIMIT, context=ours) as page:
                assert page.status == 200
            assert psutil.Process(console.process.pid).num_fds() < 1024
    assert "Traceback" not in console.log.read_text()


def test_handshakes_that_hang_are_closed_too(encrypted: Site, tmp_path: Path) -> None:
    with running(encrypted, tmp_path), hanging(encrypted.file.ports.console, MANY) as opened:
        wait_until(lambda: still_open(opened) == 0, LIMIT, "all have been closed")


def cut(console: Console, reason: str) -> float:
    """How many connections the console says it has closed."""
    with urllib.request.urlopen(f"http://127.0.0.1:{find(console.site, 'tms:ur').port}/metrics", timeout=10) as page:
        for line in page.read().decode().splitlines():
            if line.startswith(f'tms_ur_connections_cut_total{{reason="{reason}"}}'):
                return float(line.split()[-1])
    return 0.0
