"""A store that is away costs each request nothing, and is found again by itself."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest
import structlog
from pymongo.errors import AutoReconnect

from tms_db import connection, schema, store
from tms_db.connection import StoreConnection
from tms_db.reasons import NoStore, StoreDown
from tms_reason.errors import DbError
from tms_reason.reason import Foreign


class Away:
    """A database that is up or down as the test says, and counts who asks."""

    def __init__(self) -> None:
        self.up, self.asked = threading.Event(), threading.Semaphore(0)
        self.client = self
        self.name = "rostmsdb"

    def __getitem__(self, _: str) -> "Away":
        return self

    def find_one(self, *_: Any) -> dict[str, Any]:
        self.create_index()
        return {"version": schema.NEWEST}

    def create_index(self, *_: Any, **__: Any) -> None:
        self.asked.release()
        if not self.up.is_set():
            raise AutoReconnect("away")

    def command(self, _: str) -> None:
        self.create_index()

    def close(self) -> None:
        pass


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> Away:
    monkeypatch.setattr(connection, "FIRST_WAIT", 0.001)
    monkeypatch.setattr(connection, "LAST_WAIT", 0.002)
    monkeypatch.setattr(connection, "IDLE_CHECK_PERIOD", 60.0)
    return Away()


@pytest.fixture
def link(fake: Any) -> Iterator[StoreConnection]:
    link = StoreConnection(fake, "mongodb://here", structlog.stdlib.get_logger("test"))
    link.start()
    yield link
    link.stop()


def wait_ready(link: StoreConnection, ready: bool) -> None:
    tick = threading.Event()
    for _ in range(2000):
        if (link.unready() is None) == ready:
            return
        tick.wait(0.005)
    pytest.fail(f"did not become {'ready' if ready else 'unready'}")


def use(link: StoreConnection, error: DbError | None = None) -> str:
    try:
        with link.use():
            if error:
                raise error
    except DbError as caught:
        return caught.code
    return "OK"


def test_away_at_the_start_then_there(fake: Away, link: StoreConnection) -> None:
    assert link.unready() == StoreDown(NoStore())
    assert use(link) == "STORE_DOWN"
    assert fake.asked.acquire(timeout=5)
    fake.up.set()
    wait_ready(link, True)
    assert use(link) == "OK"


def test_a_lost_store_is_noticed_by_the_first_who_asks(fake: Away, link: StoreConnection) -> None:
    fake.up.set()
    wait_ready(link, True)
    fake.up.clear()
    assert use(link, store.down()) == "STORE_DOWN"
    wait_ready(link, False)  # at once, long before the next regular look
    fake.up.set()
    wait_ready(link, True)


def test_a_refusal_is_no_loss(fake: Away, link: StoreConnection) -> None:
    fake.up.set()
    wait_ready(link, True)
    assert use(link, DbError(Foreign("no"), "TASK_MISSING")) == "TASK_MISSING"
    assert link.unready() is None


def test_trouble_is_told_once(fake: Away, caplog: pytest.LogCaptureFixture) -> None:
    link = StoreConnection(fake, "mongodb://here", structlog.stdlib.get_logger("test"))  # type: ignore[arg-type]
    link.start()
    for _ in range(5):
        assert fake.asked.acquire(timeout=5)
    link.stop()
    reported = [record for record in caplog.records if "store_away" in record.getMessage()]
    assert len(reported) == 1
