"""Keeps which run has which machine, for sites with several schedulers: serves /tms/db/lease_machines.

A lease is in the database before it is answered. Renewing changes nothing there: it goes on while the store is away.
"""

import threading
from collections.abc import Mapping
from dataclasses import asdict

from tms_msg_db.srv import LeaseMachines

from tms_config.clock import monotonic
from tms_db.connection import StoreConnection
from tms_db.store import Db
from tms_db.whole_document import WholeDocument
from tms_reason.errors import DbError, TmsError
from tms_reason.wire import to_line
from tms_runtime.app import App
from tms_schedulers.lease_book import LEASE, Lease, LeaseBook
from tms_schedulers.reasons import LeasesUnread, LeasesUnreadable

COLLECTION = "machine_lease"


class MachineLeases:
    """The keeper of the site's leases."""

    def __init__(self, app: App, db: Db, connection: StoreConnection) -> None:
        self._app, self._document, self._connection = app, WholeDocument(db, COLLECTION), connection
        self._lock = threading.Lock()
        self._book: LeaseBook | None = None  # until it was read

    def offer(self) -> None:
        """Serve it; each call has a thread of its own, since it may wait for the store."""
        self._app.ros.offer_slow(LeaseMachines, "/tms/db/lease_machines", self.lease)

    def lease(self, request: LeaseMachines.Request, response: LeaseMachines.Response) -> LeaseMachines.Response:
        """Give a run its machines, renew them, or take them back."""
        lease = Lease(request.scheduler, request.run_id, request.number)
        try:
            with self._lock:
                book, now = self._read(), monotonic()
                if request.over:
                    changed = book.given_back(lease, request.machines)
                else:
                    changed = book.wanted(lease, request.machines, now)
                if changed:
                    self._write({**book.leases, **changed})
                book.put(changed, () if request.over else request.machines, now)
                response.last, response.seconds = book.last, LEASE
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
            self._app.log.info("lease_refused", run=request.run_id, reason=error.reason)
        return response

    def _read(self) -> LeaseBook:
        if self._book is None:
            if self._connection.unready() is not None:
                raise DbError(LeasesUnread(), "STORE_DOWN")
            with self._connection.use():
                found = self._document.read() or {"leases": {}}
            try:
                leases = {name: Lease(**one) for name, one in found["leases"].items()}
            except (KeyError, TypeError, AttributeError) as error:
                raise DbError(LeasesUnreadable(), "BAD_RECORD") from error
            self._book = LeaseBook(leases, monotonic())
        return self._book

    def _write(self, leases: Mapping[str, Lease]) -> None:
        with self._connection.use():
            self._document.write({"leases": {name: asdict(one) for name, one in leases.items()}})
