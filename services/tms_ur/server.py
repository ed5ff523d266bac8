"""Runs uvicorn behind the gate of connections.py, in a thread of its own; the runtime handles signals."""

import functools
import socket
import threading
from typing import Any

import h11
import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from tms_config.clock import monotonic
from tms_config.site_file import Files
from tms_reason.reason import Reason
from tms_ur.connections import BODY, HEADERS, SILENCE, Connection, Gate, Listener
from tms_ur.reasons import ServerEnded, ServerStarting

REQUESTS_END_LIMIT = 0.8  # s for open requests to end; the runtime ends the process within 2 s
KEEP_ALIVE = 15  # s that an idle connection waits for its next request
CONNECTIONS_CHECK_TICKS = 2  # ticks of uvicorn (0.1 s) between checks of the connections


class Server:
    """The web server of this process."""

    def __init__(self, application: object, listener: Listener, tls: Files | None) -> None:
        listener.gate = gate = Gate()
        config = uvicorn.Config(
            application,  # type: ignore[arg-type]  # FastAPI's types differ from uvicorn's
            http=functools.partial(Watched, gate),  # type: ignore[arg-type]  # uvicorn only calls it
            log_config=None, log_level="warning", access_log=False, ws="none", loop="asyncio",
            lifespan="on", server_header=False, proxy_headers=False, timeout_keep_alive=KEEP_ALIVE,
            ssl_certfile=tls.certificate if tls else None, ssl_keyfile=tls.key if tls else None,
        )  # fmt: skip
        self._server = _Looking(config, gate)
        self._thread = threading.Thread(target=self._server.run, args=([listener],), name="http", daemon=True)
        self._thread.start()

    def unready(self) -> Reason | None:
        """Why requests are not answered; None if they are."""
        if not self._thread.is_alive():
            return ServerEnded("tms:ur")
        return None if self._server.started else ServerStarting()

    def stop(self) -> None:
        """Give open requests a moment to end, then drop them."""
        self._server.should_exit = True
        self._thread.join(REQUESTS_END_LIMIT)
        self._server.force_exit = True
        self._thread.join(0.2)


class _Looking(uvicorn.Server):
    """Checks the connections on uvicorn's ticks."""

    def __init__(self, config: uvicorn.Config, gate: Gate) -> None:
        super().__init__(config)
        self._gate = gate

    async def on_tick(self, counter: int) -> bool:
        if counter % CONNECTIONS_CHECK_TICKS == 0:
            self._gate.close_hanging()
        return await super().on_tick(counter)


class Watched(H11Protocol):
    """A connection of uvicorn that records what it waits for, and since when."""

    def __init__(self, gate: Gate, **of_uvicorn: Any) -> None:
        super().__init__(**of_uvicorn)
        self._gate = gate
        self._connection: Connection | None = None
        self._begun = monotonic()  # begin of the present request, or of the wait for it
        self._received = self._begun  # last piece of the request
        self._idle = False  # answered, and no byte of a next request was received
        self._unread, self._read = 0, self._begun  # waiting bytes of the answer, and when their number fell last

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        sock: socket.socket | None = transport.get_extra_info("socket")
        self._connection = None if sock is None else self._gate.serve(sock.fileno(), self)
        if self._connection is None:  # the gate has closed it during the handshake
            transport.abort()

    def data_received(self, data: bytes) -> None:
        self._received = monotonic()
        if self._idle:
            self._idle, self._begun = False, self._received
        super().data_received(data)

    def on_response_complete(self) -> None:
        self._idle, self._begun = True, monotonic()
        if self._connection is not None:
            self._connection.since = self._begun
        super().on_response_complete()

    def hanging(self) -> bool:
        """Whether it waits for a complete request."""
        return self._answered() or self.conn.their_state is h11.SEND_BODY

    def overdue(self, now: float) -> str:
        """Why it must be closed even when there is room; empty if it need not."""
        if self._unread_for(now) > SILENCE:
            return "slow_reader"
        if self._answered():  # uvicorn closes idle ones
            return "headers" if not self._idle and now - self._begun > HEADERS else ""
        if self.conn.their_state is h11.SEND_BODY and (now - self._received > SILENCE or now - self._begun > BODY):
            return "body"
        return ""

    def abort(self) -> None:
        """Close at once; data that was not sent yet is lost."""
        self.transport.abort()

    def _answered(self) -> bool:
        """Whether no request is being answered."""
        return self.cycle is None or self.cycle.response_complete

    def _unread_for(self, now: float) -> float:
        """Seconds since the client has last taken a part of the waiting answer."""
        unread = self.transport.get_write_buffer_size()
        if unread < self._unread or not unread:
            self._read = now
        self._unread = unread
        return now - self._read
