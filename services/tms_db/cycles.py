"""Cycles of work in the database: one document a cycle; writing one twice changes nothing."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from pydantic import ValidationError
from pymongo.errors import DuplicateKeyError

from tms_db.reasons import BadCycle, CycleUnreadable
from tms_db.store import Db, errors, long_work
from tms_reason import validation
from tms_reason.errors import DbError
from tms_work.cycle import Cycle

COLLECTION = "cycle"


class Cycles:
    """The collection `cycle`; a cycle is known by its run, machine and number, so none counts twice."""

    def __init__(self, db: Db) -> None:
        self._db = db

    def write(self, cycles: Sequence[Cycle]) -> None:
        """Store cycles; one that is there already is replaced.

        Raises:
            DbError: the store is away; then all may be sent again.
        """
        with errors():
            for one in cycles:
                key = {"run_id": one.run_id, "machine": one.machine, "number": one.number}
                try:
                    self._db[COLLECTION].replace_one(key, one.model_dump(), upsert=True)
                except DuplicateKeyError:  # it was sent again while its first write was under way: it is there now
                    self._db[COLLECTION].replace_one(key, one.model_dump())

    def find(
        self, run_id: str = "", machine: str = "", begin: datetime | None = None, end: datetime | None = None
    ) -> list[Cycle]:
        """Cycles in the order of their ends.

        Args:
            run_id: of this run only.
            machine: of this machine only.
            begin: that ended at this time or later.
            end: that ended before this time.

        Raises:
            DbError: the store is away, or holds a cycle that is none.
        """
        query: dict[str, Any] = {name: value for name, value in (("run_id", run_id), ("machine", machine)) if value}
        times = {name: value for name, value in (("$gte", begin), ("$lt", end)) if value is not None}
        if times:
            query["ended_at"] = times
        with long_work(self._db):
            documents = list(self._db[COLLECTION].find(query, {"_id": 0}).sort([("ended_at", 1), ("machine", 1)]))
        return [_cycle(document) for document in documents]


def checked(data: Any) -> Cycle:
    """A cycle from outside.

    Raises:
        DbError: BAD_CYCLE; names the field.
    """
    try:
        return Cycle.model_validate(data)
    except ValidationError as error:
        raise DbError(BadCycle(validation.explain(error))) from error


def _cycle(document: dict[str, Any]) -> Cycle:
    try:
        return Cycle.model_validate(document)
    except ValidationError as error:
        where = f"{document.get('run_id')}/{document.get('machine')}/{document.get('number')}"
        raise DbError(CycleUnreadable(where, validation.explain(error)), "BAD_RECORD") from error
