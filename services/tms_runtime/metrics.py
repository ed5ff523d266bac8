"""Metrics and health of a process on its own port: /metrics, /healthz (alive), /readyz (can work).

The labels of the scrape target, not of each metric, name process, machine and role of a figure.
Labels of a metric take their values from the code or from the process table, never from data.
"""

import asyncio
import http.client
import re
import socket
import threading
from collections.abc import Callable
from http import HTTPStatus

from prometheus_client import CONTENT_TYPE_LATEST, REGISTRY, CollectorRegistry, Counter, Gauge, Info, generate_latest

from tms_config.processes import Process
from tms_reason import wire
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_runtime.reasons import PortSilent, PortTaken

READY = Gauge("tms_process_ready", "1 when the process can do its job")
BUILD = Info("tms_build", "Version that runs")
ENDPOINTS = Gauge("tms_ros_matched_endpoints", "Remote ends that this process is connected to", ["kind"])
NODES = Gauge("tms_ros_nodes", "Nodes that this process sees in its domain")
STOOD_STILL = Counter("tms_stood_still_seconds", "Time in which this PC did not run the process, or it was frozen")

MAX_CONNECTIONS = 64  # connections; beyond it, the oldest one without a request is closed
BACKLOG = 512  # connections that wait to be accepted; beyond it, the system makes them wait for a second or more
REQUEST_LIMIT = 5.0  # s for a request to arrive, and again for its answer to be read
LONGEST = 8192  # bytes of a request's first line and headers
END = b"\r\n\r\n"
REQUEST = re.compile(rb"([A-Z]{1,20}) (/[!-~]*) HTTP/1\.[0-9]\r\n")


def unready(row: Process, seconds: float = 2.0) -> Reason | None:
    """Why a process cannot work now, from its health port; None when it can."""
    status, text = page(row, "/readyz", seconds)
    if not status:
        return PortSilent(row.full)
    return None if status == http.HTTPStatus.OK else wire.known(text.strip())


def page(row: Process, path: str = "/metrics", seconds: float = 2.0) -> tuple[int, str]:
    """Status and text of a page of a process; (0, "") if it does not answer."""
    asked = http.client.HTTPConnection(row.address, row.port, timeout=seconds)
    try:
        asked.request("GET", path)
        answer = asked.getresponse()
        return answer.status, answer.read().decode("utf-8", "replace")
    except (OSError, http.client.HTTPException):  # also of a process that ends while it answers
        return 0, ""
    finally:
        asked.close()


class Health:
    """HTTP server of one process; `unready` returns why it cannot work, `hangs` why it needs a restart, or None.

    One thread serves all connections and sleeps while there is no request. Each connection is for one answer.
    """

    def __init__(
        self,
        bind: str,
        port: int,
        unready: Callable[[], Reason | None],
        hangs: Callable[[], Reason | None] = lambda: None,
        registry: CollectorRegistry = REGISTRY,
    ) -> None:
        self._answer = lambda path: _answer(path, unready, hangs, registry)
        try:
            self._socket = socket.create_server((bind, port), backlog=BACKLOG)  # without a call of a name server
        except OSError as error:
            raise ConfigError(PortTaken(port, bind, str(error.strerror))) from error
        self._loop, self._stop = asyncio.new_event_loop(), asyncio.Event()
        self._connections = _Connections()
        self._thread = threading.Thread(target=self._run, name="metrics", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Close the port; open connections get no answer."""
        self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join()

    def _run(self) -> None:
        self._loop.run_until_complete(self._serve())
        self._loop.close()

    async def _serve(self) -> None:
        server = await self._loop.create_server(
            lambda: _Connection(self._connections, self._answer), sock=self._socket, backlog=BACKLOG
        )
        await self._stop.wait()
        self._loop.remove_reader(self._socket)  # asyncio would lose a connection that is being accepted now
        self._connections.limit = 0
        while self._connections.drop_oldest() or len(asyncio.all_tasks()) > 1:
            await asyncio.sleep(0)
        server.close()
        await asyncio.sleep(0)


class _Connections:
    """The open connections, in the order in which they came, or were answered."""

    def __init__(self) -> None:
        self.limit = MAX_CONNECTIONS
        self._open: dict[asyncio.Transport, None] = {}

    def add(self, one: asyncio.Transport) -> None:
        self._open.pop(one, None)
        self._open[one] = None
        while len(self._open) > self.limit:
            self.drop_oldest()

    def drop_oldest(self) -> bool:
        oldest = next(iter(self._open), None)
        if oldest is not None:
            del self._open[oldest]
            oldest.abort()
        return oldest is not None

    def remove(self, one: asyncio.Transport) -> None:
        self._open.pop(one, None)


class _Connection(asyncio.Protocol):
    """One request and its answer."""

    _transport: asyncio.Transport
    _time: asyncio.TimerHandle

    def __init__(self, connections: _Connections, answer: Callable[[str], tuple[int, str, bytes]]) -> None:
        self._connections, self._answer = connections, answer
        self._request = b""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        self._limit_time()
        self._connections.add(transport)

    def data_received(self, data: bytes) -> None:
        self._request += data
        if END in self._request or len(self._request) > LONGEST:
            self._time.cancel()
            self._limit_time()
            self._connections.add(self._transport)  # connections without a request are closed first
            self._transport.write(self._response())
            self._transport.close()  # closes once the answer is written

    def connection_lost(self, exc: Exception | None) -> None:
        self._time.cancel()
        self._connections.remove(self._transport)

    def _limit_time(self) -> None:
        self._time = asyncio.get_running_loop().call_later(REQUEST_LIMIT, self._transport.abort)

    def _response(self) -> bytes:
        if len(self._request) > LONGEST:
            return _encode(431, "text/plain", b"the request is too long\n")
        asked = REQUEST.match(self._request)
        if asked is None:
            return _encode(400, "text/plain", b"what came is no HTTP request\n")
        if asked[1] != b"GET":
            return _encode(405, "text/plain", b"GET only\n")
        return _encode(*self._answer(asked[2].decode("ascii")))


def _encode(status: int, kind: str, body: bytes) -> bytes:
    head = f"HTTP/1.0 {status} {HTTPStatus(status).phrase}\r\nContent-Type: {kind}\r\nContent-Length: {len(body)}"
    return head.encode() + END + body


def _answer(
    path: str, unready: Callable[[], Reason | None], hangs: Callable[[], Reason | None], registry: CollectorRegistry
) -> tuple[int, str, bytes]:
    if path == "/metrics":
        READY.set(unready() is None)
        return 200, CONTENT_TYPE_LATEST, generate_latest(registry)
    if path == "/healthz":
        return _verdict(hangs(), b"ok\n")
    if path == "/readyz":
        return _verdict(unready(), b"ready\n")
    return 404, "text/plain", b"try /metrics, /healthz or /readyz\n"


def _verdict(reason: Reason | None, good: bytes) -> tuple[int, str, bytes]:
    return (200, "text/plain", good) if reason is None else (503, "text/plain", f"{wire.to_line(reason)}\n".encode())
