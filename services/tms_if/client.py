"""One connection to the bridge, from handshake to end. A faulty client can harm only its own connection."""

import socket
import threading
from collections.abc import Callable

from prometheus_client import Counter, Gauge

from tms_if.client_endpoints import ClientEndpoints
from tms_if.commands import CommandError, Registration, Removal, ServiceId, command, handshake, parse
from tms_if.framing import Frame, FrameError, Splitter
from tms_if.send_queue import SendQueue
from tms_runtime.log import Logger

SILENCE = 10.0  # s; the simulator sends a keep-alive every second
PIECE = 65536  # bytes of one read
TROUBLES = 50  # different troubles that are reported, each once

FRAMES = Counter("tms_if_frames_total", "Frames by direction", ["direction"])
DROPPED = Counter("tms_if_dropped_total", "Messages that a client did not read in time")
TROUBLE = Counter("tms_if_troubles_total", "Frames of clients that could not be used")
CLIENTS = Gauge("tms_if_clients", "Connected clients")

REGISTRATIONS: dict[str, Callable[[ClientEndpoints, Registration], None]] = {
    "__publish": ClientEndpoints.publish,
    "__subscribe": ClientEndpoints.subscribe,
    "__ros_service": ClientEndpoints.ros_service,
    "__unity_service": ClientEndpoints.unity_service,
}
REMOVALS: dict[str, Callable[[ClientEndpoints, str], None]] = {
    "__remove_publisher": ClientEndpoints.remove_publisher,
    "__remove_subscriber": ClientEndpoints.remove_subscriber,
    "__remove_ros_service": ClientEndpoints.remove_ros_service,
    "__remove_unity_service": ClientEndpoints.remove_unity_service,
}


class Client:
    """Reads in the thread that calls `run`, and sends in a thread of its own."""

    def __init__(
        self,
        connection: socket.socket,
        name: str,
        log: Logger,
        message_limit: int,
        ends: Callable[[Callable[[bytes, bool], None], Callable[[str], None]], ClientEndpoints],
    ) -> None:
        self._socket, self._name, self._log = connection, name, log
        self._splitter, self._queue = Splitter(message_limit), SendQueue()
        self._ends = ends(self._send, self._trouble)
        self._expected: tuple[str, int] | None = None  # kind of the next frame, __request or __response, and its number
        self._reported: set[str] = set()
        self._why = ""  # why the bridge has closed it

    def run(self) -> None:
        """Serve until the client leaves or breaks the protocol, or `close` is called."""
        self._log.info("client_connected", client=self._name)
        CLIENTS.inc()
        self._socket.settimeout(SILENCE)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        sender = threading.Thread(target=self._send_all, name="sender", daemon=True)
        self._queue.put(handshake())
        sender.start()
        reason = "ended by an error of the bridge"
        try:
            reason = self._read_all()
        finally:
            self.close("")
            self._ends.close()
            CLIENTS.dec()
            DROPPED.inc(self._queue.dropped)
            self._log.info("client_gone", client=self._name, dropped=self._queue.dropped, reason=self._why or reason)

    def close(self, why: str) -> None:
        """End the connection from any thread; `why` is for the log."""
        self._why = self._why or why
        self._queue.close()
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass  # it was closed already
        self._socket.close()

    def _read_all(self) -> str:
        """Read frames until the end of the connection; returns the reason of the end as text."""
        try:
            while data := self._socket.recv(PIECE):
                for frame in self._splitter.feed(data):
                    FRAMES.labels("in").inc()
                    self._take(frame)
        except FrameError as error:
            return f"it sent {error}"
        except TimeoutError:
            return f"silent for {SILENCE:.0f} s{self._half()}"
        except OSError as error:
            return f"connection lost ({error.strerror or error}){self._half()}"
        return f"it left{self._half()}"

    def _half(self) -> str:
        pending = self._splitter.pending
        return f" in the middle of a message, after {pending} bytes of it" if pending else ""

    def _take(self, frame: Frame) -> None:
        if frame.keep_alive:
            return
        try:
            self._dispatch(frame)
        except CommandError as error:
            self._trouble(str(error))

    def _dispatch(self, frame: Frame) -> None:
        name, payload, expected = frame.destination, frame.payload, self._expected
        self._expected = None
        if expected is not None and not name.startswith("__"):
            what, number = expected
            if what == "__request":
                self._ends.request(name, payload, number)
            else:
                self._ends.response(payload, number)
        elif name in ("__request", "__response"):
            self._expected = name, parse(ServiceId, name, payload).srv_id
        elif name in REGISTRATIONS:
            REGISTRATIONS[name](self._ends, parse(Registration, name, payload))
        elif name in REMOVALS:
            REMOVALS[name](self._ends, parse(Removal, name, payload).topic)
        elif name == "__topic_list":
            topics, types = self._ends.topics()
            self._send(command(name, topics=topics, types=types), False)
        elif name.startswith("__"):
            raise CommandError(f"there is no command {name[:40]}")
        else:
            self._ends.message(name, payload)

    def _trouble(self, text: str) -> None:
        """Report a trouble to the client and the log, each once: a faulty client repeats it at 50 Hz."""
        TROUBLE.inc()
        if text in self._reported or len(self._reported) >= TROUBLES:
            return
        self._reported.add(text)
        self._log.warning("client_trouble", client=self._name, reason=text)
        self._send(command("__error", text=text), False)

    def _send(self, frame: bytes, droppable: bool) -> None:
        """Queue a frame; may be called from any thread and never waits."""
        before = self._queue.dropped
        if not self._queue.put(frame, droppable):
            self.close("it does not read: even answers find no room any more")
        elif before == 0 and self._queue.dropped:
            self._log.warning("client_slow", client=self._name, reason="it reads too slowly: messages get lost")

    def _send_all(self) -> None:
        try:
            while (frame := self._queue.take()) is not None:
                self._socket.sendall(frame)
                FRAMES.labels("out").inc()
        except TimeoutError:
            self.close(f"it did not read for {SILENCE:.0f} s")
        except OSError as error:
            self.close(f"connection lost ({error.strerror or error})")
