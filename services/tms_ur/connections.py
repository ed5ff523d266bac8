"""Bounds the console's connections and closes hanging ones, so that a stop always gets a connection.

A new connection is always accepted. To make room, the gate closes the oldest hanging connection, which has not sent
a whole request: half a TLS handshake, half a header, half a body, or nothing at all. A connection that is being
answered, such as a viewer's stream, is never closed to make room. A request must arrive within seconds, and the client
must read its answer.
Used on the event loop only.
"""

import socket
from collections import Counter
from collections.abc import Callable
from typing import Any, Protocol

from prometheus_client import Counter as Metric

from tms_config.clock import monotonic
from tms_ur.callers import caller

MAX_CONNECTIONS = 300  # connections after hanging ones were closed
MAX_OF_ONE = 64  # of them from one address
FULL = 600  # connections before that; below FD_SETSIZE (1024), beyond which DDS may not open its files
ROOM = 50  # connections that are closed together when the gate is full
GRACE = 0.5  # s that a connection has for its request before it may be closed to make room
HEADERS = 5.0  # s for the TLS handshake and the headers of a request
SILENCE = 5.0  # s between two pieces of a body, and without a byte of an answer being read
SENT = 128 * 1024  # bytes of an answer that wait in the system for a slow reader; the system doubles this number
BODY = 60.0  # s for a whole request: a tree of 6 MB by a slow line

CUT = Metric("tms_ur_connections_cut_total", "Connections that were closed by the console", ["reason"])


class ServedConnection(Protocol):
    """A connection of the web server (server.py) as the gate uses it."""

    def hanging(self) -> bool:
        """Whether it waits for a complete request."""

    def overdue(self, now: float) -> str:
        """Why it must be closed even when there is room; empty if it need not."""

    def abort(self) -> None:
        """Close at once; data that was not sent yet is lost."""


class Connection:
    """One accepted socket; `served` as soon as the TLS handshake is over."""

    def __init__(self, sock: socket.socket, address: str, now: float) -> None:
        self.sock, self.descriptor, self.caller, self.since = sock, sock.fileno(), caller(address), now
        self.served: ServedConnection | None = None

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
            self.sock.shutdown(socket.SHUT_RDWR)  # the event loop owns the socket and closes it then
        except OSError:  # the client has closed it
            return


class Gate:
    """All connections by their file descriptor; the system reuses a descriptor as soon as it is closed."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._there: dict[int, Connection] = {}

    def room(self) -> bool:
        """Whether one more may be accepted now; False after others were closed, since that takes a turn of the loop."""
        if len(self._there) < FULL:
            return True
        self.close_hanging()
        oldest = self._oldest_hanging(0.0)[:ROOM]
        for one in oldest:
            self._cut(one, "full")
        return not oldest

    def admit(self, sock: socket.socket, address: str) -> bool:
        """Take a new connection; False if it had to be closed, since all others are being answered."""
        if len(self._there) >= FULL:
            CUT.labels("refused").inc()
            sock.close()
            return False
        self._there[sock.fileno()] = Connection(sock, address, self._clock())
        return True

    def serve(self, descriptor: int, served: ServedConnection) -> Connection | None:
        """Note that the web server serves a connection from now on; None if it was closed meanwhile."""
        found = self._there.get(descriptor)
        if found is not None:
            found.served = served
        return found

    def close_hanging(self) -> None:
        """Close connections that hang for too long, and the oldest hanging ones where there are too many."""
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
    """A listening socket that passes connections to the gate before the TLS handshake, which may hang, too."""

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
