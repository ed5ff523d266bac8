"""Databases for the contract tests: in memory, in a store server, or in the MongoDB of TMS_TEST_MONGODB_URI."""

import os
import shutil
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import mongomock
import pytest

from stores import PROGRAM, MongoDb, Server
from tms_db import store

names = count(1)
PATIENT = 30_000  # ms that threads which keep a busy PC busy wait for an answer


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server | MongoDb]:
    if uri := os.environ.get("TMS_TEST_MONGODB_URI"):
        yield MongoDb(uri)
        return
    _need_program()
    server = Server(tmp_path_factory.mktemp("store"))
    yield server
    server.end(kill=True)


@pytest.fixture
def own_server(tmp_path: Path) -> Iterator[Server]:
    """One that a test may kill."""
    _need_program()
    server = Server(tmp_path / "store")
    yield server
    server.end(kill=True)
    shutil.rmtree(server.folder)


@pytest.fixture(scope="session")
def program() -> None:
    """The embedded store is installed."""
    _need_program()


def _need_program() -> None:
    if not PROGRAM.exists():
        pytest.fail(f"no real store here ({PROGRAM} is missing): `make setup` installs it")


@pytest.fixture(params=["memory", "server"])
def db(request: pytest.FixtureRequest) -> Iterator[store.Db]:
    if request.param == "memory":
        db: store.Db = mongomock.MongoClient(tz_aware=True)["rostmsdb"]
        store.prepare(db)
        yield db
        return
    yield from _fresh(request.getfixturevalue("server"))


@pytest.fixture
def shared_db(server: Server | MongoDb, monkeypatch: pytest.MonkeyPatch) -> Iterator[store.Db]:
    """For several threads at once: the in-memory store is made for one. Its answers may take long on a busy PC."""
    monkeypatch.setattr(store, "FIND_SERVER_MS", PATIENT)
    yield from _fresh(server, PATIENT)


def _fresh(server: Server | MongoDb, answer_ms: int = store.ANSWER_MS) -> Iterator[store.Db]:
    db = server.open(f"test{next(names)}", answer_ms)
    yield db
    server.forget(db)
