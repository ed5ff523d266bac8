"""Keeps the store's connection: knows whether it is up, and brings it back in the background."""

from collections.abc import Iterator
from contextlib import contextmanager

from prometheus_client import Gauge
from pymongo.errors import PyMongoError

from tms_db import schema, store
from tms_db.worker import Worker
from tms_reason.errors import DbError
from tms_reason.reason import Reason
from tms_runtime.log import Logger

FIRST_WAIT = 0.2  # s after a failed attempt; doubles up to LAST_WAIT
LAST_WAIT = 2.0
UP = Gauge("tms_db_store_up", "1 while the store answers")
IDLE_CHECK_PERIOD = 2.0  # s between checks of a store that is not in use


class StoreConnection:
    """One store. While it is away every use fails at once instead of waiting for a time-out each."""

    def __init__(self, db: store.Db, address: str, log: Logger) -> None:
        self._db, self._address, self._log = db, address, log
        self._trouble: DbError | None = store.down()  # until the first attempt says otherwise
        self._reported = ""  # code of the trouble that is in the log already, so that it is logged once
        self._wait = FIRST_WAIT
        self._worker = Worker("store", self._keep)

    def start(self) -> None:
        """Begin to connect; returns at once."""
        self._worker.start()

    def stop(self) -> None:
        self._worker.stop()
        self._db.client.close()

    def unready(self) -> Reason | None:
        """Why the store cannot be used now, or None."""
        trouble = self._trouble
        return trouble.reason if trouble else None

    @contextmanager
    def use(self) -> Iterator[None]:
        """Around each use of the database.

        Raises:
            DbError: the store is away, or was lost just now.
        """
        if self._trouble is not None:
            raise DbError(self._trouble.reason, self._trouble.code)
        try:
            yield
        except DbError as error:
            if error.code == "STORE_DOWN":
                self._lose(error)
            raise

    def _lose(self, trouble: DbError) -> None:
        self._report(trouble)
        self._trouble = trouble
        UP.set(False)
        self._worker.wake()

    def _keep(self) -> float:
        trouble = self._attempt()
        self._report(trouble)
        self._trouble = trouble
        UP.set(trouble is None)
        if trouble is None:
            self._wait = FIRST_WAIT
            return IDLE_CHECK_PERIOD
        wait, self._wait = self._wait, min(2 * self._wait, LAST_WAIT)
        return wait

    def _attempt(self) -> DbError | None:
        try:
            if self._trouble is None:
                with store.errors():
                    self._db.command("ping")
            else:
                for done in schema.bring_up(self._db):
                    self._log.info("migrated", database=self._db.name, reason=done)
        except DbError as error:
            return error
        except (PyMongoError, RuntimeError):  # the client was closed meanwhile
            if not self._worker.stopping:
                raise
        return None

    def _report(self, trouble: DbError | None) -> None:
        if self._worker.stopping:
            return
        if trouble is None and self._trouble is not None:
            self._log.info("store_up", address=self._address)
            self._reported = ""
        elif trouble is not None and trouble.code != self._reported:
            self._log.warning("store_away", code=trouble.code, address=self._address, reason=trouble.reason)
            self._reported = trouble.code
