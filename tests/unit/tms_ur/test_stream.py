"""Server-sent events, asked for as a server does, since the test client waits for the end of an answer."""

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from tms_ur import stream
from tms_ur.models import Machine
from unit.tms_ur.fakes import FakeSiteClient, app

LIMIT = 5.0  # s
SCOPE = {
    "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": "GET", "scheme": "http",
    "path": "/api/events", "raw_path": b"/api/events", "query_string": b"", "root_path": "",
    "headers": [(b"host", b"127.0.0.1:8080")], "client": ("127.0.0.1", 1), "server": ("127.0.0.1", 8080),
}  # fmt: skip


class Console:
    """One connected client; `stuck` takes nothing."""

    def __init__(self, app: Any, stuck: bool = False) -> None:
        self.sent: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self._stuck, self._gone = stuck, asyncio.Event()
        self.task = asyncio.create_task(app(dict(SCOPE), self._receive, self._send))

    async def _receive(self) -> dict[str, Any]:
        await self._gone.wait()
        return {"type": "http.disconnect"}

    async def _send(self, message: dict[str, Any]) -> None:
        if self._stuck and message["type"] == "http.response.body":
            await asyncio.Event().wait()
        self.sent.put_nowait(message)

    async def message(self) -> dict[str, Any]:
        return await asyncio.wait_for(self.sent.get(), LIMIT)

    async def state(self) -> dict[str, Any]:
        body = (await self.message())["body"].decode()
        assert body.startswith("event: state\ndata: {")
        assert body.endswith("}\n\n")
        found: dict[str, Any] = json.loads(body.partition("data: ")[2])
        return found

    async def leave(self) -> None:
        self._gone.set()
        await asyncio.wait_for(self.task, LIMIT)


Scenario = Callable[[FakeSiteClient, Any], Awaitable[None]]


def play(scenario: Scenario) -> None:
    site_client = FakeSiteClient()
    asyncio.run(scenario(site_client, app(site_client)))


def test_first_state_comes_at_once_and_changes_follow() -> None:
    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        console = Console(app)
        start = await console.message()
        headers = dict(start["headers"])
        assert start["status"] == 200
        assert headers[b"content-type"].startswith(b"text/event-stream")
        assert headers[b"x-frame-options"] == b"DENY"
        assert (await console.state())["machines"][0]["state"] == "silent"
        await asyncio.to_thread(site_client.board.put_machine, Machine(name="zx200", state="moving"))
        while (await console.state())["machines"][0]["state"] != "moving":
            pass
        await console.leave()

    play(scenario)


def test_without_a_change_there_is_a_state_every_two_seconds_at_least() -> None:
    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        console = Console(app)
        await console.message()
        await console.state()
        await asyncio.wait_for(console.state(), 2.0)
        await console.leave()

    play(scenario)


def test_at_most_seventeen_states_a_second() -> None:
    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        console = Console(app)
        loop = asyncio.get_running_loop()
        begun = loop.time()
        while loop.time() - begun < 0.55:
            site_client.board.put_machine(Machine(name="zx200", state="moving", goal=str(loop.time())))
            await asyncio.sleep(0)
        assert console.sent.qsize() <= 1 + 1 + 10
        await console.leave()

    play(scenario)


def test_clients_are_bounded_and_leave_their_place() -> None:
    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        consoles = [Console(app) for _ in range(stream.MAX_CLIENTS)]
        for console in consoles:
            assert (await console.message())["status"] == 200
        late = Console(app)
        assert (await late.message())["status"] == 503
        assert json.loads((await late.message())["body"])["code"] == "TOO_MANY_CONSOLES"
        await consoles[0].leave()
        next_one = Console(app)
        assert (await next_one.message())["status"] == 200
        for console in [*consoles[1:], next_one]:
            await console.leave()

    play(scenario)


def test_a_client_that_does_not_read_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stream, "SLOW_LIMIT", 0.05)

    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        stuck, fine = Console(app, stuck=True), Console(app)
        await asyncio.wait_for(stuck.task, LIMIT)
        for _ in range(2):
            await fine.message()
        await fine.state()
        await fine.leave()

    play(scenario)


def test_a_slow_client_gets_the_newest_state_only() -> None:
    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        client = stream.StreamClient()
        for text in (b"1", b"2", b"3"):
            client.put(text)
        assert await client.next() == b"3"

    play(scenario)


def test_the_end_of_the_process_ends_the_streams() -> None:
    async def scenario(site_client: FakeSiteClient, app: Any) -> None:
        console = Console(app)
        await console.message()
        await console.state()
        site_client.board.close()
        await asyncio.wait_for(console.task, 30)

    play(scenario)
