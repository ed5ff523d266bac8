"""Pieces of recordings: how they are packed, and what becomes of those that wait for a store that is away."""

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timezone
from types import SimpleNamespace
from typing import Any

import mongomock
import numpy as np
import pytest
import structlog

from conftest import wait_until
from tms_db import recorder, store
from tms_db.recorder import Pieces
from tms_db.recording_piece import JOINTS, POSE, Piece, packed, unpacked
from tms_db.recordings import thinned

NOON = datetime(2026, 1, 31, 12, tzinfo=timezone.utc)
NAMES = ("boom_joint", "arm_joint")
LOG = structlog.stdlib.get_logger("test")
ONE_PC = SimpleNamespace(file=SimpleNamespace(machines=(), pcs={}))
LIMIT = 30.0  # s


def piece(machine: str = "zx200", rows: int = 100) -> Piece:
    made = Piece(machine, NOON, 50.0)
    for row in range(rows):
        made.add(JOINTS, NAMES, 50.0 + row / 10, (-0.5 + row * 0.01, 1.25))
    return made


def test_rows_come_back_as_they_were() -> None:
    rows = np.cumsum(np.random.default_rng(3).normal(size=(100, 8)) * [1, 1e-3, 1e-2, 0.1, 1, 10, 1e4, 1e6], axis=0)
    stored = {"names": list("abcdefg"), "rows": 100, "data": packed(rows)}
    assert np.abs(unpacked(stored) - rows).max() <= 0.51e-5


@pytest.mark.parametrize("told", [1e300, -1e300, 1e18])
def test_a_number_that_nobody_believes_breaks_nothing(told: float) -> None:
    stored = {"names": ["x"], "rows": 2, "data": packed(np.array([[0.0, told], [1.0, 2.0]]))}
    assert unpacked(stored)[1].tolist() == pytest.approx([1.0, 2.0])


def test_a_machine_that_stands_takes_little() -> None:
    standing = np.column_stack([np.arange(100) / 10, np.tile(np.linspace(-1, 1, 5), (100, 1))])
    assert len(packed(standing)) < 250 < standing.nbytes / 10


def test_a_piece_tells_each_kind_by_its_names() -> None:
    made = piece(rows=3)
    made.add(POSE, ("x", "y", "yaw"), 50.2, (10.0, 20.0, 0.5))
    document = made.document()
    assert document is not None and (document["machine"], document["begin"]) == ("zx200", NOON)
    assert unpacked(document["series"][POSE])[0] == pytest.approx([0.2, 10.0, 20.0, 0.5])
    assert unpacked(document["series"][JOINTS])[:, 0] == pytest.approx([0.0, 0.1, 0.2])
    assert Piece("zx200", NOON, 0.0).document() is None


def test_thin_rows_keep_both_ends() -> None:
    rows = np.arange(1000.0).reshape(-1, 1)
    assert thinned(rows, 1000) is rows
    thin = thinned(rows, 11)[:, 0]
    assert (thin[0], thin[-1], len(thin)) == (0.0, 999.0, 11)
    assert np.diff(thin).min() >= 99


class Away:
    """A store's connection that the test cuts."""

    def __init__(self) -> None:
        self.there = threading.Event()
        self.asked = 0

    @contextmanager
    def use(self) -> Iterator[None]:
        self.asked += 1
        if not self.there.is_set():
            raise store.down()
        yield


@pytest.fixture
def connection() -> Away:
    return Away()


def waiting(connection: Away) -> tuple[Any, Pieces]:
    db: Any = mongomock.MongoClient(tz_aware=True)["rostmsdb"]
    return db, Pieces(db, connection, LOG)  # type: ignore[arg-type]


def numbers(db: Any) -> list[str]:
    return sorted(one["machine"] for one in db["recording"].find())


def test_pieces_wait_for_the_store_and_are_stored_once(
    connection: Away, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.setattr(recorder, "AGAIN", 0.01)
    db, pieces = waiting(connection)
    pieces.worker.start()
    for number in range(3):
        pieces.put(piece(f"m{number}"))
    wait_until(lambda: connection.asked > 2, LIMIT, "it has tried again")
    assert numbers(db) == []
    connection.there.set()
    wait_until(lambda: len(numbers(db)) == 3, LIMIT, "all are stored")
    pieces.worker.stop(LIMIT)
    assert numbers(db) == ["m0", "m1", "m2"] and pieces._waiting == type(pieces._waiting)()


def test_of_too_many_that_wait_the_oldest_are_lost_and_counted(
    connection: Away, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    document = piece().document()
    assert document is not None
    size = len(document["series"][JOINTS]["data"])
    monkeypatch.setattr(recorder, "WAITING", 5 * size)
    db, pieces = waiting(connection)
    before = recorder.DROPPED._value.get()
    for number in range(8):
        pieces.put(piece(f"m{number}"))
    assert recorder.DROPPED._value.get() - before == 3
    connection.there.set()
    assert pieces._write() == math.inf
    assert numbers(db) == [f"m{number}" for number in range(3, 8)]
    assert pieces._bytes == 0


class Topics:
    """What the recorder hears, without ROS."""

    def __init__(self) -> None:
        self.runs: list[Any] = []
        self.made = self.ended = 0

    def sample(self, *_: Any) -> Any:
        return lambda: self.runs

    def tell(self, *names: str) -> None:
        self.runs = [SimpleNamespace(runs=list(names))]


def test_machines_are_heard_only_around_a_run(connection: Away, monkeypatch: pytest.MonkeyPatch) -> None:
    """No run: nothing is subscribed to. A run that ends has its pieces at once, and a tail."""
    topics, now = Topics(), [100.0]

    class Hearing:
        def __init__(self, *_: Any) -> None:
            topics.made += 1

        def end(self) -> None:
            topics.ended += 1

        def take(self, _: int) -> Iterator[Any]:
            yield "zx200", (JOINTS, NAMES, (now[0], 0.0))

    monkeypatch.setattr(recorder, "Hearing", Hearing)
    monkeypatch.setattr(recorder, "monotonic", lambda: now[0])
    monkeypatch.setattr(recorder, "utc_now", lambda: datetime.fromtimestamp(now[0], timezone.utc))
    connection.there.set()
    db: Any = mongomock.MongoClient(tz_aware=True)["rostmsdb"]
    made = recorder.Recorder(SimpleNamespace(ros=topics, site=ONE_PC, log=LOG), db, connection)  # type: ignore[arg-type]

    def go(seconds: float) -> None:
        for _ in range(round(seconds * 10)):
            made._step()
            made.pieces._write()
            now[0] += 0.1

    topics.tell()
    go(2.0)
    assert (topics.made, made._step()) == (0, recorder.LOOK)
    topics.tell("run-1")
    go(12.0)
    assert (topics.made, topics.ended, db["recording"].count_documents({})) == (1, 0, 1)
    topics.tell()
    go(0.1)
    assert db["recording"].count_documents({}) == 2, "what the run has told is there when it is over"
    go(recorder.TAIL + 1)
    assert (topics.made, topics.ended) == (1, 1)
    found = [unpacked(one["series"][JOINTS]) for one in db["recording"].find().sort("begin", 1)]
    assert 218 <= sum(map(len, found)) <= 222
    assert max(rows[-1, 0] - rows[0, 0] for rows in found) <= 10.0
