"""Records that were read are remembered until the store tells that somebody has changed them."""

import queue
from collections.abc import Callable
from typing import Any, cast

import pytest
import structlog

from conftest import wait_until
from stores import Server
from tms_db import store
from tms_db.connection import StoreConnection
from tms_db.parameters import Parameters, RecordEdit
from tms_db.record_cache import RecordCache
from tms_db.watching import Watching
from tms_reason.errors import DbError
from tms_ros.node import Ros

KEY = ("zx200", "p")
LOG = structlog.stdlib.get_logger("test")


class Executor:
    """Runs steps at once."""

    def on_executor(self, step: Callable[[], None]) -> None:
        step()


class Rig:
    """RecordCache on a store, told of changes by hand."""

    def __init__(self, db: store.Db) -> None:
        self.records = db["parameter"]
        self.parameters = Parameters(db)
        self.parameters.set(*KEY, RecordEdit({"x": 1.0}, "static"), create=True)
        self.watched = True
        self.heads = RecordCache(self.parameters, lambda _: {}, cast(Ros, Executor()), lambda: self.watched)

    def x(self) -> Any:
        return self.heads.document(KEY)["x"]

    def write_elsewhere(self, x: float) -> Any:
        self.records.update_one({"record_name": "p"}, {"$set": {"x": x}})
        document = self.records.find_one({"record_name": "p"})
        assert document is not None
        return document["_id"]


@pytest.fixture
def rig(db: store.Db) -> Rig:
    return Rig(db)


def test_a_record_is_read_once_until_the_store_tells_of_a_change(rig: Rig) -> None:
    assert rig.x() == 1.0
    identity = rig.write_elsewhere(2.0)
    assert rig.x() == 1.0  # nothing was told yet
    rig.heads.changed(identity)
    assert rig.x() == 2.0
    rig.write_elsewhere(3.0)
    rig.heads.changed(None)
    assert rig.x() == 3.0


def test_without_a_change_stream_every_reader_gets_what_is_stored(rig: Rig) -> None:
    assert rig.x() == 1.0
    rig.watched = False
    rig.write_elsewhere(2.0)
    assert rig.x() == 2.0
    rig.write_elsewhere(3.0)
    assert rig.x() == 3.0


def test_what_is_on_its_way_into_the_store_is_read_at_once_and_its_own_echo_changes_nothing(rig: Rig) -> None:
    rig.x()
    head = rig.heads.get(KEY)
    head.change({"x": 5.0})
    rig.heads.changed(head.id)
    assert rig.x() == 5.0
    assert not head.quiet


def test_a_record_that_was_removed_is_missing(rig: Rig) -> None:
    rig.x()
    identity = rig.write_elsewhere(2.0)
    rig.parameters.remove(*KEY)
    rig.heads.changed(identity)
    with pytest.raises(DbError, match="there is no"):
        rig.x()


def test_the_store_tells_of_changes_by_anybody(server: Server, shared_db: store.Db) -> None:
    reported: queue.Queue[Any] = queue.Queue()
    own = store.connect(server.uri, shared_db.name)
    connection = StoreConnection(own, "the store", LOG)
    watching = Watching(own, connection, LOG, reported.put)
    records = shared_db["parameter"]
    connection.start()
    watching.start()
    try:
        assert reported.get(timeout=20) is None  # from now on
        wait_until(watching.sure, 20, "the stream is there")
        made = records.insert_one({"model_name": "m", "record_name": "r"}).inserted_id
        records.update_one({"_id": made}, {"$set": {"x": 1}})
        records.delete_one({"_id": made})
        assert [reported.get(timeout=20) for _ in range(3)] == [made] * 3
    finally:
        watching.stop()
        connection.stop()
    wait_until(lambda: not watching.sure(), 20, "a stream that has ended is not relied on")
