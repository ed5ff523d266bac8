"""A collection with one document, which is read and written whole."""

from collections.abc import Mapping
from typing import Any

from pymongo.errors import DuplicateKeyError

from tms_db.store import Db, errors

KEY = {"_id": "book"}  # key of the only document


class WholeDocument:
    """That of one collection."""

    def __init__(self, db: Db, collection: str) -> None:
        self._db, self._collection = db, collection

    def read(self) -> dict[str, Any] | None:
        """The document with its key; None where none was written.

        Raises:
            DbError: the store is away.
        """
        with errors():
            return self._db[self._collection].find_one(KEY)

    def write(self, fields: Mapping[str, Any]) -> None:
        """Keep it in place of the one before.

        Raises:
            DbError: the store is away; the one before may still count.
        """
        with errors():
            try:
                self._db[self._collection].replace_one(KEY, fields, upsert=True)
            except DuplicateKeyError:  # it was made meanwhile
                self._db[self._collection].replace_one(KEY, fields)
