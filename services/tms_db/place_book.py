"""The book of shared places in the database: one document, written whole."""

from pymongo.errors import DuplicateKeyError

from tms_db.reasons import PlacesUnreadable
from tms_db.store import Db, errors
from tms_places.claims import Book, of_document, to_document
from tms_reason.errors import DbError

COLLECTION = "place"
KEY = {"_id": "book"}  # key of the only document


class PlaceBook:
    """The collection `place`."""

    def __init__(self, db: Db) -> None:
        self._db = db

    def read(self) -> Book:
        """Who holds and who waits; an empty book where none was written.

        Raises:
            DbError: the store is away, or the document is no book.
        """
        with errors():
            found = self._db[COLLECTION].find_one(KEY)
        if found is None:
            return Book()
        try:
            return of_document(found)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise DbError(PlacesUnreadable(), "BAD_RECORD") from error

    def write(self, book: Book) -> None:
        """Keep a book in place of the one before.

        Raises:
            DbError: the store is away; the one before may still count.
        """
        with errors():
            try:
                self._db[COLLECTION].replace_one(KEY, to_document(book), upsert=True)
            except DuplicateKeyError:  # it was made meanwhile
                self._db[COLLECTION].replace_one(KEY, to_document(book))
