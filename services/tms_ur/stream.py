"""Server-sent events: one snapshot is made for all clients; their number is bounded, and each has one slot.

A snapshot holds the whole state, so a client needs only the newest: its queue is a single slot that a newer snapshot
overwrites, and memory stays bounded however slowly it reads. A client that does not take one for SLOW_LIMIT is dropped.
"""

import asyncio

import anyio
import structlog
from fastapi.sse import format_sse_event
from prometheus_client import Counter, Gauge
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from tms_reason.errors import TmsError
from tms_ur.board import Board
from tms_ur.reasons import TooManyConsoles

MAX_CLIENTS = 50
SHORTEST = 0.06  # s between snapshots: with the 0.05 s of the scheduler, a change is seen within 0.15 s
LONGEST = 0.7  # s between snapshots without a change; the console shows the connection as lost after 1.7 s
SLOW_LIMIT = 5.0  # s that a client has to take one snapshot

CLIENTS = Gauge("tms_ur_stream_clients", "Connected consoles")
DROPPED = Counter("tms_ur_stream_dropped_total", "Consoles dropped because they read too slowly")
HEADERS = [(b"content-type", b"text/event-stream; charset=utf-8"), (b"x-accel-buffering", b"no")]
log = structlog.stdlib.get_logger(__name__)


class StreamClient:
    """The slot of one client; used on the event loop only."""

    def __init__(self) -> None:
        self._pending = asyncio.Event()
        self._text: bytes = b""
        self._ended = False

    def put(self, text: bytes) -> None:
        self._text = text
        self._pending.set()

    def end(self) -> None:
        self._ended = True
        self._pending.set()

    async def next(self) -> bytes | None:
        """Wait for a snapshot that was not sent yet and return the newest; None at the end."""
        await self._pending.wait()
        self._pending.clear()
        return None if self._ended else self._text


class Stream:
    """Makes snapshots while there are clients."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._clients: set[StreamClient] = set()
        self._changed = asyncio.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._pump: asyncio.Task[None] | None = None
        self._last = b""
        board.on_change(self._wake)

    def join(self) -> StreamClient:
        """Add a client, which gets a snapshot at once.

        Raises:
            TmsError: there are too many clients.
        """
        if len(self._clients) >= MAX_CLIENTS:
            raise TmsError(TooManyConsoles(MAX_CLIENTS))
        client = StreamClient()
        self._clients.add(client)
        CLIENTS.set(len(self._clients))
        client.put(self._text())
        if self._pump is None or self._pump.done():
            self._loop = asyncio.get_running_loop()
            self._pump = self._loop.create_task(self._run())
        return client

    def leave(self, client: StreamClient) -> None:
        self._clients.discard(client)
        CLIENTS.set(len(self._clients))

    def _wake(self) -> None:
        """Wake the event loop; may be called on any thread."""
        loop = self._loop
        if loop is not None and not loop.is_closed():
            loop.call_soon_threadsafe(self._changed.set)

    def _text(self) -> bytes:
        return format_sse_event(event="state", data_str=self._board.snapshot().model_dump_json())

    async def _run(self) -> None:
        while self._clients and not self._board.closed:
            with anyio.move_on_after(LONGEST):
                await self._changed.wait()
            self._changed.clear()
            text = self._text()
            for client in self._clients:
                client.put(text)
            await asyncio.sleep(SHORTEST)
        for client in self._clients:
            client.end()


class StreamResponse(Response):
    """Sends the snapshots of a client's slot until one side closes."""

    media_type = "text/event-stream"

    def __init__(self, stream: Stream) -> None:
        super().__init__()
        self._stream = stream

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        client = self._stream.join()
        watcher = asyncio.create_task(_end_when_gone(receive, client))
        try:
            await send({"type": "http.response.start", "status": 200, "headers": HEADERS})
            while (text := await client.next()) is not None:
                if not await _sent(send, text):
                    DROPPED.inc()
                    log.warning("console_dropped", source=scope.get("client"), reason="reads too slowly")
                    return  # the answer has no end, so the server closes the connection
            await send({"type": "http.response.body", "body": b"", "more_body": False})
        finally:
            watcher.cancel()
            self._stream.leave(client)


async def _sent(send: Send, text: bytes) -> bool:
    with anyio.move_on_after(SLOW_LIMIT):
        await send({"type": "http.response.body", "body": text, "more_body": True})
        return True
    return False


async def _end_when_gone(receive: Receive, client: StreamClient) -> None:
    """Wait for the client to disconnect: the server's `send` does not report that, its `receive` does."""
    while (await receive())["type"] != "http.disconnect":
        pass
    client.end()
