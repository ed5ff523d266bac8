"""Opens the site's database directly, for verbs that move more data than a service should carry."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from tms_cli import session

if TYPE_CHECKING:
    from tms_db.store import Db

ANSWER_MS = 60_000  # one step may touch a whole collection


@contextmanager
def opened() -> Iterator["Db"]:
    """The database of the chosen site, for the length of one command."""
    from tms_db import store, store_address

    site = session.site()
    db = store.connect(store_address.uri(site), site.file.store.database, ANSWER_MS)
    try:
        yield db
    finally:
        db.client.close()
