"""The connection to the endpoint: made again and again, as the simulator's connector does. It never blocks."""

import errno
import json
import random
import socket
from collections.abc import Callable
from typing import Any

from operasim.framing import KEEP_ALIVE, FrameError, Splitter
from operasim.outbox import Outbox
from operasim.registration import Registration, on_connect

VERSION, COMPATIBLE, PROTOCOL = "v0.7.1", "v0.7.", "ROS2"
QUIET = 1.0  # s without a frame until it sends a keep-alive
RETRY = 1.0  # s from the end of a connection to the next attempt
PATIENCE = 2.0  # s that an attempt may take
POLL = 0.01  # s between two looks of the simulator's reader at an idle connection
PIECE = 65536  # bytes of one read

Event = Callable[..., None]  # a name and fields


class Connection:
    """One at a time. Times are the seconds of any steady clock.

    Nothing waits for the handshake before it sends; but what comes first must be one of v0.7 for ROS 2.
    """

    def __init__(self, address: tuple[str, int], chance: random.Random, event: Event, begin: float = 0.0) -> None:
        """The first attempt is made at the time `begin`."""
        self._address, self._chance, self._event = address, chance, event
        self._registered: list[Registration] = []
        self._outbox, self._inbox = Outbox(), list[tuple[float, str, bytes]]()
        self._socket: socket.socket | None = None
        self._splitter, self._pending = Splitter(), b""
        self._made = self._greeted = False
        self._since = self._sent = 0.0  # begin of the attempt; last sending
        self._not_before = begin
        self._times = 0  # connections so far
        self._refused = ""  # why the last attempt failed: told once

    @property
    def connected(self) -> bool:
        """Whether it is, with a handshake."""
        return self._greeted

    def register(self, one: Registration) -> None:
        """Register a topic, now and at each connection."""
        self._registered.append(one)
        if self._made:
            self._outbox.command(one.command)

    def send(self, topic: str, payload: bytes) -> None:
        """Send a message; without a connection it is lost."""
        if self._made:
            self._outbox.message(topic, payload)

    def heard(self, now: float) -> list[tuple[str, bytes]]:
        """Messages that have come: the reader has seen them by now."""
        count = sum(1 for due, _, _ in self._inbox if due <= now)
        found, self._inbox = self._inbox[:count], self._inbox[count:]
        return [(topic, payload) for _, topic, payload in found]

    def waits_for(self) -> tuple[list[socket.socket], list[socket.socket]]:
        """What it wants to read from and to write to."""
        if self._socket is None:
            return [], []
        return ([self._socket] if self._made else []), ([self._socket] if not self._made or self._pending else [])

    def work(self, now: float) -> None:
        """Connect, read and write as far as that is possible at once."""
        try:
            if self._socket is None:
                self._connect(now)
            elif not self._made:
                self._finish(now)
            if self._made:
                self._read(now)
                self._write(now)
        except (OSError, FrameError) as error:
            self.close(getattr(error, "strerror", None) or str(error), now)

    def close(self, why: str, now: float, pause: float = RETRY) -> None:
        """End it, if there is one; the next attempt comes after a pause [s]. What waits is forgotten."""
        if self._socket is not None:
            self._socket.close()
        if self._made:
            self._event("disconnected", reason=why, dropped=self._outbox.dropped)
        elif self._socket is not None and why != self._refused:
            self._event("not_connected", reason=why)
            self._refused = why
        self._socket, self._pending, self._splitter = None, b"", Splitter()
        self._made = self._greeted = False
        self._outbox.clear()
        self._not_before = now + pause

    def _connect(self, now: float) -> None:
        if now < self._not_before:
            return
        self._socket, self._since = socket.socket(), now
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if (code := self._socket.connect_ex(self._address)) not in (0, errno.EINPROGRESS):
            raise OSError(code, errno.errorcode[code])

    def _finish(self, now: float) -> None:
        assert self._socket is not None
        if code := self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR):
            raise OSError(code, errno.errorcode[code])
        try:
            self._socket.getpeername()
        except OSError as error:
            if error.errno != errno.ENOTCONN:
                raise
            if now - self._since > PATIENCE:
                raise TimeoutError(errno.ETIMEDOUT, "no answer") from error
            return
        self._made, self._refused, self._sent = True, "", now
        self._times += 1
        self._event("connected", address=f"{self._address[0]}:{self._address[1]}", time=self._times)
        self._outbox.command(KEEP_ALIVE)
        for one in on_connect(self._registered, first=self._times == 1):
            self._outbox.command(one)

    def _read(self, now: float) -> None:
        assert self._socket is not None
        try:
            data = self._socket.recv(PIECE)
        except BlockingIOError:
            return
        if not data:
            raise ConnectionError(errno.ECONNRESET, "the endpoint has closed it")
        due = max(now + self._chance.uniform(0.0, POLL), self._inbox[-1][0] if self._inbox else 0.0)
        for destination, payload in self._splitter.feed(data):
            self._take(destination, payload, due)

    def _take(self, destination: str, payload: bytes, due: float) -> None:
        if not self._greeted:
            self._greet(destination, payload)
        elif not destination.startswith("__"):
            self._inbox.append((due, destination, payload))
        elif destination in ("__log", "__warn", "__error"):
            self._event("endpoint_says", level=destination[2:], text=_object(payload).get("text"))

    def _greet(self, destination: str, payload: bytes) -> None:
        """Take the first frame, which must be the handshake."""
        if destination != "__handshake":
            raise FrameError(f"the endpoint is of version 0.6.0 or older: it begins with {destination}")
        told = _object(payload)
        version, protocol = str(told.get("version")), _object(str(told.get("metadata"))).get("protocol")
        if not version.startswith(COMPATIBLE) or protocol != PROTOCOL:
            raise FrameError(f"an endpoint of {version}, {protocol}; wanted {VERSION}, {PROTOCOL}")
        self._greeted = True
        self._event("handshake", version=version, protocol=protocol)

    def _write(self, now: float) -> None:
        assert self._socket is not None
        if not self._pending and now - self._sent > QUIET:
            self._pending = self._outbox.take() or KEEP_ALIVE
        while self._pending or self._next():
            try:
                count = self._socket.send(self._pending)
            except BlockingIOError:
                return
            self._pending, self._sent = self._pending[count:], now

    def _next(self) -> bool:
        """Whether there is a frame to send."""
        self._pending = self._outbox.take() or b""
        return bool(self._pending)


def _object(text: bytes | str) -> dict[str, Any]:
    try:
        found = json.loads(text)
    except ValueError as error:
        raise FrameError(f"what should be JSON is not: {text[:80]!r}") from error
    if not isinstance(found, dict):
        raise FrameError(f"no object: {text[:80]!r}")
    return found
