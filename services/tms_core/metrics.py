"""Metrics and health of a process on its own port: /metrics, /healthz (alive), /readyz (can work).

Which process, machine and role a figure belongs to is told by the scrape target's labels, not by every metric.
Labels in a metric take their values from the code or from the process table, never from data.
"""

import http.client
import socket
import threading
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer

from prometheus_client import CONTENT_TYPE_LATEST, REGISTRY, CollectorRegistry, Gauge, Info, generate_latest

from tms_core.errors import ConfigError

READY = Gauge("tms_process_ready", "1 when the process can do its job")
BUILD = Info("tms_build", "Version that runs")
ENDPOINTS = Gauge("tms_ros_matched_endpoints", "Remote ends that this process is connected to", ["kind"])
NODES = Gauge("tms_ros_nodes", "Nodes that this process sees in its domain")


def unready(address: str, port: int, seconds: float = 2.0) -> str | None:
    """Why a process cannot work now, as it says itself on its port; None when it can."""
    asked = http.client.HTTPConnection(address, port, timeout=seconds)
    try:
        asked.request("GET", "/readyz")
        answer = asked.getresponse()
        text = answer.read().decode("utf-8", "replace").strip()
    except (OSError, http.client.HTTPException):  # also one that ends while it answers
        return "it does not answer on its health port"
    finally:
        asked.close()
    return None if answer.status == http.HTTPStatus.OK else text


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def server_bind(self) -> None:
        """Without HTTPServer's question for this PC's name: 6 s a start where no name server answers."""
        TCPServer.server_bind(self)
        self.server_name, self.server_port = str(self.server_address[0]), int(self.server_address[1])


class Health:
    """HTTP server of one process; `unready` returns why it cannot work, `hangs` why it needs a restart, or None."""

    def __init__(
        self,
        bind: str,
        port: int,
        unready: Callable[[], str | None],
        hangs: Callable[[], str | None] = lambda: None,
        registry: CollectorRegistry = REGISTRY,
    ) -> None:
        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                self.send(*_answer(self.path, unready, hangs, registry))

            def send(self, status: int, kind: str, body: bytes) -> None:
                self.send_response(status)
                self.send_header("Content-Type", kind)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, format: str, *args: object) -> None:
                """Scrapes are no news."""

        try:
            self._server = _Server((bind, port), Handler)
        except OSError as error:
            raise ConfigError(
                f"port {port} on {bind} is taken ({error.strerror}): "
                "stop the other program or change ports.metrics in the site file"
            ) from error
        self._closing = False
        self._thread = threading.Thread(target=self._serve, name="metrics", daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        """Without `serve_forever`, which looks every 0.5 s whether it should end, and takes as long to do so."""
        while not self._closing:
            self._server.handle_request()

    def close(self) -> None:
        """Free the port."""
        self._closing = True
        self._server.socket.shutdown(socket.SHUT_RDWR)  # wakes the thread
        self._thread.join()
        self._server.server_close()


def _answer(
    path: str, unready: Callable[[], str | None], hangs: Callable[[], str | None], registry: CollectorRegistry
) -> tuple[int, str, bytes]:
    if path == "/metrics":
        READY.set(unready() is None)
        return 200, CONTENT_TYPE_LATEST, generate_latest(registry)
    if path == "/healthz":
        return _verdict(hangs(), b"ok\n")
    if path == "/readyz":
        return _verdict(unready(), b"ready\n")
    return 404, "text/plain", b"try /metrics, /healthz or /readyz\n"


def _verdict(reason: str | None, good: bytes) -> tuple[int, str, bytes]:
    return (200, "text/plain", good) if reason is None else (503, "text/plain", f"{reason}\n".encode())
