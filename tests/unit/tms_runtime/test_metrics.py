"""The health port of a process."""

import os
import re
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from prometheus_client import CollectorRegistry, Gauge

from tms_config.processes import Process
from tms_machine.reasons import Busy
from tms_reason import wire
from tms_reason.errors import ConfigError
from tms_runtime import metrics

ADDRESS, PORT = f"127.7.{os.getpid() // 250 % 250}.{os.getpid() % 250 + 1}", 29411  # of this test run alone
ROW = Process("tms", "ts", "cps", "m", PORT, "", address=ADDRESS)
BUSY = Busy("tms:ts")
WHOLE = b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n"


@pytest.fixture
def health() -> Iterator[metrics.Health]:
    made = metrics.Health(ADDRESS, PORT, unready=lambda: BUSY, registry=CollectorRegistry())
    yield made
    made.close()


def dial() -> socket.socket:
    return socket.create_connection((ADDRESS, PORT), timeout=10)


def ask(data: bytes) -> bytes:
    with dial() as client:
        client.sendall(data)
        return everything(client)


def everything(client: socket.socket) -> bytes:
    """Until the other side ends the connection, however it does."""
    got = b""
    try:
        while piece := client.recv(65536):
            got += piece
    except ConnectionResetError:
        pass
    return got


def test_it_opens_without_asking_a_name_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """A site's network may have none; each question would last for seconds."""

    def ask_name(*_names: Any) -> str:
        pytest.fail("a name server was asked")

    for name in ("getfqdn", "gethostbyaddr", "gethostbyname"):
        monkeypatch.setattr(socket, name, ask_name)
    health = metrics.Health(ADDRESS, PORT, unready=lambda: BUSY)
    try:
        assert metrics.unready(ROW) == BUSY
    finally:
        health.close()


def test_what_each_path_answers(health: metrics.Health) -> None:
    assert ask(WHOLE).startswith(b"HTTP/1.0 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 3\r\n\r\nok\n")
    assert ask(b"GET /readyz HTTP/1.1\r\n\r\n").endswith(wire.to_line(BUSY).encode() + b"\n")
    assert b" 404 " in ask(b"GET /other HTTP/1.1\r\n\r\n")
    assert b" 200 OK" in ask(b"GET /metrics HTTP/1.1\r\n\r\n")


def test_it_stays_in_reach_while_others_hang(health: metrics.Health) -> None:
    """Half of them say nothing, half a part of a request; threads and connections stay few."""
    threads = threading.active_count()
    with ExitStack() as open_:
        hanging = [open_.enter_context(dial()) for _ in range(200)]
        for client in hanging[::2]:
            client.sendall(b"GET /healthz HTT")
        for _ in range(20):
            began = time.monotonic()
            assert metrics.unready(ROW, seconds=2.0) == BUSY
            assert time.monotonic() - began < 2.0
        assert threading.active_count() <= threads  # those of other tests may end meanwhile
        assert everything(hanging[0]) == b""  # the oldest gave way
        hanging[-1].sendall(WHOLE)  # a young one still gets its answer, if it asks
        assert everything(hanging[-1]).endswith(b"ok\n")


def test_who_asks_nothing_is_dropped(health: metrics.Health, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(metrics, "REQUEST_LIMIT", 0.2)
    with dial() as idle, dial() as slow:
        slow.sendall(b"GET /healthz HTTP/1.1\r\nHost:")
        assert everything(idle) == everything(slow) == b""


def test_who_does_not_take_the_answer_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(metrics, "REQUEST_LIMIT", 0.5)
    registry = CollectorRegistry()
    figure = Gauge("large", "More than the system takes for a client that does not read", ["number"], registry=registry)
    for number in range(100_000):
        figure.labels(f"{number:0100d}").set(1)
    health = metrics.Health(ADDRESS, PORT, unready=lambda: None, registry=registry)
    client = socket.socket()
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    client.settimeout(60)
    try:
        client.connect((ADDRESS, PORT))
        client.sendall(b"GET /metrics HTTP/1.1\r\n\r\n")
        _until(lambda: health._connections._open, "the request has come")
        _until(lambda: not health._connections._open, "it was dropped")
        got = everything(client)
        (length,) = re.findall(rb"Content-Length: (\d+)", got)
        assert len(got) < int(length)
    finally:
        client.close()
        health.close()


def _until(holds: Any, what: str) -> None:
    deadline = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < deadline, what
        time.sleep(0.01)


@pytest.mark.parametrize(
    ("data", "answer"),
    [
        (b"\r\n\r\n", b"HTTP/1.0 400 "),
        (b"\xff\xfe\0\r\n\r\n", b"HTTP/1.0 400 "),
        (b"GET\r\n\r\n", b"HTTP/1.0 400 "),
        (b"GET /healthz\r\n\r\n", b"HTTP/1.0 400 "),
        (b"GET /a\0b HTTP/1.1\r\n\r\n", b"HTTP/1.0 400 "),
        (b"GET /\xe6 HTTP/1.1\r\n\r\n", b"HTTP/1.0 400 "),
        (b"POST /metrics HTTP/1.1\r\n\r\n", b"HTTP/1.0 405 "),
        (b"\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03\r\n\r\n", b"HTTP/1.0 400 "),  # TLS
    ],
)
def test_a_broken_request_is_answered_quietly(
    health: metrics.Health, data: bytes, answer: bytes, capfd: pytest.CaptureFixture[str],
    caplog: pytest.LogCaptureFixture,
) -> None:  # fmt: skip
    assert ask(data).startswith(answer)
    assert metrics.unready(ROW) == BUSY
    assert capfd.readouterr() == ("", "") and not caplog.records


def test_a_request_without_end_is_cut(
    health: metrics.Health, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    with dial() as client:
        client.sendall(b"GET /healthz HTTP/1.1\r\n" + b"X: " + b"x" * metrics.LONGEST)
        assert everything(client)[:13] == b"HTTP/1.0 431 "
    with dial() as client:  # without a pause, and its end cut off
        try:
            for _ in range(100):
                client.sendall(b"x" * metrics.LONGEST)
        except OSError:
            pass  # that is what should happen
    with dial() as client:
        client.sendall(b"GET /hea")
    assert metrics.unready(ROW) == BUSY
    assert capfd.readouterr() == ("", "") and not caplog.records


def test_it_closes_at_once_and_frees_its_port() -> None:
    health = metrics.Health(ADDRESS, PORT, unready=lambda: None)
    with pytest.raises(ConfigError, match=f"port {PORT} on {ADDRESS} is taken .*ports.metrics"):
        metrics.Health(ADDRESS, PORT, unready=lambda: None)
    with dial() as hanging:
        began = time.monotonic()
        health.close()
        assert time.monotonic() - began < metrics.REQUEST_LIMIT - 1  # waits for no time-out
        assert everything(hanging) == b""
    metrics.Health(ADDRESS, PORT, unready=lambda: None).close()
