"""The console's connections: how many there are, and which of them must go so that a stop always gets in.

A connection is accepted always; what makes room is the oldest one that has not sent a whole request: half a TLS
handshake, half a header, half a body, or nothing at all. One that is being answered, a stream of a viewer above all,
is never cut for others. Besides, a request must be there within seconds, and an answer must be read.
Used on the event loop only.
"""

import socket
from collections import Counter
from collections.abc import Callable
from typing import Any, Protocol

from prometheus_client import Counter as Metric

from tms_config.clock import monotonic
from tms_ur.callers import caller

MAX_CONNECTIONS = 300  # connections once those that hang are cut
MAX_OF_ONE = 64  # of them from one address
FULL = 600  # connections in the moment before; below FD_SETSIZE (1024), beyond which DDS may not open its files
ROOM = 50  # that are cut at once when it is full
GRACE = 0.5  # s that a connection has for its request before it may be cut for others
HEADERS = 5.0  # s for the TLS handshake and the headers of a request
SILENCE = 5.0  # s between two pieces of a body, and without a byte of an answer being read
SENT = 128 * 1024  # bytes (the system doubles it) of an answer that wait in the system for a slow reader
BODY = 60.0  # s for a whole request: a tree of 6 MB by a slow line

CUT = Metric("tms_ur_connections_cut_total", "Connections that were closed by the console", ["reason"])


class Served(Protocol):
    """What the gate asks the web server about a connection (server.py)."""

    def hanging(self) -> bool:
        """Whether a whole request is awaited."""

    def overdue(self, now: float) -> str:
        """Why it must go by itself, empty if it need not."""

    def abort(self) -> None:
        """Close at once, whatever was not sent yet."""


class Connection:
    """One accepted socket; `served` as soon as the TLS handshake is over."""

    def __init__(self, sock: socket.socket, address: str, now: float) -> None:
        self.sock, self.descriptor, self.caller, self.since = sock, sock.fileno(), caller(address), now
        self.served: Served | None = None

    def hanging(self) -> bool:
        return self.served is None or self.served.hanging()

    def overdue(self, now: float) -> str:
        if self.served is not None:
            return self.served.overdue(now)
        return "headers" if now - self.since > HEADERS else ""

    def cut(self, reason: str) -> None:
        CUT.labels(reason).inc()
        if self.served is not None:
            self.served.abort()
            return
        try:
            self.sock.shutdown(socket.SHUT_RDWR)  # the event loop, which owns it, closes it then
        except OSError:  # it has gone by itself
            return


class Gate:
    """All connections by their file descriptor, which is free for another one as soon as one is closed."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._there: dict[int, Connection] = {}

    def room(self) -> bool:
        """Whether one more may be accepted now; False once room was made, which takes a turn of the event loop."""
        if len(self._there) < FULL:
            return True
        self.close_hanging()
        oldest = self._oldest_hanging(0.0)[:ROOM]
        for one in oldest:
            self._cut(one, "full")
        return not oldest

    def admit(self, sock: socket.socket, address: str) -> bool:
        """Take in a new one; False if it had to be closed, since all others are being answered."""
        if len(self._there) >= FULL:
            CUT.labels("refused").inc()
            sock.close()
            return False
        self._there[sock.fileno()] = Connection(sock, address, self._clock())
        return True

    def serve(self, descriptor: int, served: Served) -> Connection | None:
        """The connection that the web server talks to from now on; None if it was cut meanwhile."""
        found = self._there.get(descriptor)
        if found is not None:
            found.served = served
        return found

    def close_hanging(self) -> None:
        """Close what hangs for too long, and the oldest that hang where there are too many."""
        self._there = {fd: one for fd, one in self._there.items() if one.sock.fileno() == fd}
        now = self._clock()
        for one in list(self._there.values()):
            reason = one.overdue(now)
            if reason:
                self._cut(one, reason)
        counts = Counter(one.caller for one in self._there.values())
        for one in self._oldest_hanging(GRACE):
            if counts[one.caller] > MAX_OF_ONE or len(self._there) > MAX_CONNECTIONS:
                counts[one.caller] -= 1
                self._cut(one, "crowd")

    def _oldest_hanging(self, age: float) -> list[Connection]:
        before = self._clock() - age
        found = [one for one in self._there.values() if one.since <= before and one.hanging()]
        return sorted(found, key=lambda one: one.since)

    def _cut(self, one: Connection, reason: str) -> None:
        del self._there[one.descriptor]
        one.cut(reason)


class Listener(socket.socket):
    """A listening socket whose connections pass the gate: before the TLS handshake, which may hang, too."""

    gate: Gate

    def accept(self) -> tuple[socket.socket, Any]:
        """The next connection.

        Raises:
            BlockingIOError: the event loop closes others first, then comes here again.
        """
        if not self.gate.room():
            raise BlockingIOError
        connection, address = super().accept()
        if not self.gate.admit(connection, address[0]):
            raise BlockingIOError
        return connection, address
