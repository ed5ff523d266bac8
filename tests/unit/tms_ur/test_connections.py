"""Which connections are cut, and that requests beyond the room are refused, but never a stop."""

import asyncio
import socket
from typing import Any

import pytest

from tms_decision.reasons import SoftwareStopBy
from tms_ur import connections
from tms_ur.connections import FULL, GRACE, HEADERS, MAX_CONNECTIONS, MAX_OF_ONE, Gate, Listener
from tms_ur.room import MAX_OF_ONE as MAX_ASKED
from tms_ur.room import Room
from unit.tms_ur.fakes import FakeSiteClient, app


class FakeSocket:
    """Of the next number; closed once it was cut, as the event loop would."""

    count = 0

    def __init__(self) -> None:
        FakeSocket.count += 1
        self.number = FakeSocket.count

    def fileno(self) -> int:
        return self.number

    def shutdown(self, _how: int) -> None:
        self.close()

    def close(self) -> None:
        self.number = -1


class FakeServed:
    """A connection that is being answered, or hangs."""

    def __init__(self, sock: FakeSocket, hangs: bool) -> None:
        self.sock, self.hangs = sock, hangs

    def hanging(self) -> bool:
        return self.hangs

    def overdue(self, now: float) -> str:
        return ""

    def abort(self) -> None:
        self.sock.close()


class Door:
    """A gate with a clock that the test turns."""

    def __init__(self) -> None:
        self.now = 0.0
        self.gate = Gate(lambda: self.now)

    def come(self, address: str = "192.0.2.1", busy: bool = False) -> FakeSocket:
        sock: Any = FakeSocket()
        assert self.gate.room() or self.gate.room()
        self.gate.admit(sock, address)
        if busy:
            self.gate.serve(sock.fileno(), FakeServed(sock, hangs=False))
        return sock  # type: ignore[no-any-return]


def there(socks: list[FakeSocket]) -> list[int]:
    return [index for index, sock in enumerate(socks) if sock.fileno() >= 0]


def test_the_oldest_of_one_address_go(monkeypatch: pytest.MonkeyPatch) -> None:
    door = Door()
    other = door.come("192.0.2.2")
    many = [door.come() for _ in range(MAX_OF_ONE + 10)]
    door.gate.close_hanging()
    assert len(there(many)) == MAX_OF_ONE + 10  # they get a moment for their request
    door.now = GRACE
    door.gate.close_hanging()
    assert there(many) == list(range(10, MAX_OF_ONE + 10))
    assert there([other]) == [0]


def test_what_is_answered_stays() -> None:
    door = Door()
    viewers = [door.come(busy=True) for _ in range(50)]
    many = [door.come() for _ in range(100)]
    door.now = GRACE
    door.gate.close_hanging()
    assert len(there(viewers)) == 50
    assert there(many) == list(range(86, 100))


def test_all_together_are_limited() -> None:
    door = Door()
    many = [door.come(f"198.51.{number // 200}.{number % 200}") for number in range(MAX_CONNECTIONS + 100)]
    door.now = GRACE
    door.gate.close_hanging()
    assert there(many) == list(range(100, MAX_CONNECTIONS + 100))


def test_a_new_one_gets_in_however_many_there_are() -> None:
    door = Door()
    for _ in range(3 * FULL):
        assert door.come().fileno() >= 0
        assert len(door.gate._there) <= FULL


def test_when_all_are_answered_a_new_one_is_closed() -> None:
    door = Door()
    busy = [door.come(busy=True) for _ in range(FULL)]
    assert door.come().fileno() < 0
    assert len(there(busy)) == FULL


def test_a_handshake_takes_seconds_at_most() -> None:
    door = Door()
    slow = door.come()
    door.now = HEADERS + 0.1
    new = door.come()
    door.gate.close_hanging()
    assert there([slow, new]) == [1]


def test_who_was_cut_during_the_handshake_is_not_served() -> None:
    door = Door()
    sock = door.come()
    number = sock.fileno()
    door.now = HEADERS + 1
    door.gate.close_hanging()
    assert door.gate.serve(number, FakeServed(sock, hangs=True)) is None


def test_the_listener_lets_nobody_in_while_room_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "FULL", 2)
    made = socket.create_server(("127.0.0.1", 0))
    with Listener(fileno=made.detach()) as listener:
        listener.gate = Gate()
        listener.settimeout(10)
        with socket.create_connection(listener.getsockname()), socket.create_connection(listener.getsockname()):
            first, _ = listener.accept()
            second, _ = listener.accept()
            with socket.create_connection(listener.getsockname()):
                with pytest.raises(BlockingIOError):
                    listener.accept()
                assert first.recv(1) == b""  # it was cut
                third, address = listener.accept()
                assert address[0] == "127.0.0.1"
                for one in (first, second, third):
                    one.close()


# requests


def test_the_room_counts_by_caller() -> None:
    room = Room()
    assert [room.enter("a") for _ in range(MAX_ASKED + 1)] == [True] * MAX_ASKED + [False]
    assert room.enter("b")
    room.leave("a")
    assert room.enter("a")


async def whole() -> dict[str, Any]:
    return {"type": "http.request", "body": b"{}", "more_body": False}


async def ask(application: Any, method: str, path: str, receive: Any, address: str = "127.0.0.1") -> tuple[int, bytes]:
    headers = [(b"host", b"localhost"), (b"content-type", b"application/json"), (b"content-length", b"2")]
    scope = {"type": "http", "method": method, "path": path, "raw_path": path.encode(), "query_string": b"",
             "headers": headers, "client": (address, 1), "root_path": ""}  # fmt: skip
    sent: list[dict[str, Any]] = []

    async def send(message: Any) -> None:
        sent.append(message)

    await application(scope, receive, send)
    return sent[0]["status"], sent[1]["body"]


def test_a_stop_is_answered_when_no_other_request_is() -> None:
    """As many requests as one address may have hang in their bodies."""
    site_client = FakeSiteClient()
    application = app(site_client)

    async def story() -> None:
        never = asyncio.Event()

        async def hang() -> dict[str, Any]:
            await never.wait()
            return {"type": "http.disconnect"}

        hanging = [asyncio.create_task(ask(application, "POST", "/api/runs", hang)) for _ in range(MAX_ASKED)]
        await asyncio.sleep(0)
        while (await ask(application, "GET", "/api/state", hang))[0] != 503:
            await asyncio.sleep(0)
        assert (await ask(application, "GET", "/api/state", hang, "192.0.2.9"))[0] == 200
        status, body = await ask(application, "POST", "/api/stop", whole)
        assert (status, site_client.calls) == (200, [("stop", "zx200", SoftwareStopBy("local at 127.0.0.1"))]), body
        assert (await ask(application, "POST", "/api/runs/r-1/cancel", whole))[0] == 202
        assert (await ask(application, "POST", "/api/runs", whole))[0] == 503
        for task in hanging:
            task.cancel()
        await asyncio.gather(*hanging, return_exceptions=True)
        assert (await ask(application, "GET", "/api/state", hang))[0] == 200

    asyncio.run(asyncio.wait_for(story(), 60))
