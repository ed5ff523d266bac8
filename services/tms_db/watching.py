"""Receives from the store which records change, so that a record that was read once need not be read again.

A change stream reports all writes, also another system's in the same database. It needs a replica set (the
embedded store does without); where there is none, records are read from the store each time.
"""

from collections.abc import Callable
from typing import Any

from pymongo.errors import OperationFailure, PyMongoError

from tms_config.clock import monotonic
from tms_db.connection import StoreConnection
from tms_db.store import Db
from tms_db.worker import Worker
from tms_runtime.log import Logger

AWAIT_MS = 500  # the store waits this long for a change before it answers that there is none
SURE = 2.0  # s since its last answer for which the stream counts as up
RETRY = 2.0  # s after the stream broke ...
RETRY_REFUSED = 60.0  # s ... and after a store without change streams
WANTED = [{"$project": {"documentKey": 1, "operationType": 1}}]


class Watching:
    """A thread with the change stream of the records."""

    def __init__(self, db: Db, connection: StoreConnection, log: Logger, changed: Callable[[Any], None]) -> None:
        """`changed` is called in that thread with the _id of a record; None: any record may have changed."""
        self._records, self._connection, self._log, self._changed = db["parameter"], connection, log, changed
        self._received = float("-inf")  # s, monotonic; other threads read it
        self._worker = Worker("watching", self._keep)

    def start(self) -> None:
        self._worker.start()

    def stop(self) -> None:
        """End the thread; it ends with the client at the latest."""
        self._worker.stop()

    def sure(self) -> bool:
        """Whether the stream reports every change, except for those of the last moments."""
        return monotonic() - self._received < SURE

    def _keep(self) -> float:
        if self._connection.unready() is not None:
            return RETRY
        try:
            self._listen()
        except OperationFailure as error:
            self._log.info("no_change_stream", reason=str(error).splitlines()[0])
            return RETRY_REFUSED
        except (PyMongoError, RuntimeError) as error:  # RuntimeError: the client was closed meanwhile
            if not self._worker.stopping:
                self._log.warning("change_stream_broken", reason=str(error).splitlines()[0])
        return RETRY

    def _listen(self) -> None:
        with self._records.watch(WANTED, max_await_time_ms=AWAIT_MS) as stream:
            self._changed(None)  # changes before the stream began are not reported
            while stream.alive and not self._worker.stopping:
                change = stream.try_next()
                self._received = monotonic()
                if change is not None:
                    self._changed(change.get("documentKey", {}).get("_id"))
