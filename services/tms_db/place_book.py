"""The book of shared places in the database: one document, written whole."""

from tms_db.reasons import PlacesUnreadable
from tms_db.store import Db
from tms_db.whole_document import WholeDocument
from tms_places.claims import Book, of_document, to_document
from tms_reason.errors import DbError

COLLECTION = "place"


class PlaceBook:
    """The collection `place`."""

    def __init__(self, db: Db) -> None:
        self._document = WholeDocument(db, COLLECTION)

    def read(self) -> Book:
        """Who holds and who waits; an empty book where none was written.

        Raises:
            DbError: the store is away, or the document is no book.
        """
        found = self._document.read()
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
        self._document.write(to_document(book))
