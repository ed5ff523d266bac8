"""The version of the database's schema, and the migrations that bring an older database to it.

A database without a version is the C++ system's, or ours from before there were versions. Documents of the C++ system
(`task`, `parameter`, `machine_pose`, ...) have no migration: they stay as they are, for its nodes may go on using them.
"""

from collections.abc import Callable
from dataclasses import dataclass

from tms_config.clock import utc_now
from tms_db import store
from tms_db.reasons import NewerSchema
from tms_db.store import Db, errors
from tms_reason.errors import DbError
from tms_runtime.version import version

COLLECTION = "schema"
KEY = {"_id": "tms"}  # key of the only document


@dataclass(frozen=True)
class Migration:
    """One step; a crash may repeat it, so doing it twice must change nothing more."""

    text: str
    step: Callable[[Db], None]


def _runs_name_their_records(db: Db) -> None:
    db["run"].update_many({"records": {"$exists": False}}, {"$set": {"records": []}})


def _runs_have_values(db: Db) -> None:
    db["run"].update_many({"values": {"$exists": False}}, {"$set": {"values": []}})


# Step n brings a database from version n - 1 to n. Never change or remove one that was released: append.
MIGRATIONS = (
    Migration("runs name the records that they use", _runs_name_their_records),
    Migration("runs have further values", _runs_have_values),
)
NEWEST = len(MIGRATIONS)


def bring_up(db: Db) -> list[str]:
    """Bring the database to this program's version: migrations, then indexes. Returns the steps that were done.

    Raises:
        DbError: STORE_NEWER when a newer program has changed it, STORE_CONFLICT, or the store is away.
    """
    found = stored(db)
    refuse_newer(f"database {db.name}", found)
    done = []
    for number, migration in enumerate(MIGRATIONS[found:], found + 1):
        with store.long_work(db):
            migration.step(db)
            state = {"version": number, "changed_at": utc_now(), "by": version()}
            db[COLLECTION].update_one(KEY, {"$set": state}, upsert=True)
        done.append(f"schema {number}: {migration.text}")
    store.prepare(db)
    return done


def stored(db: Db) -> int:
    """The version in the database; 0 if there is none.

    Raises:
        DbError: the store is away.
    """
    with errors():
        return number_of(db[COLLECTION].find_one(KEY))


def number_of(document: object) -> int:
    """The version in the schema's document."""
    number = document.get("version") if isinstance(document, dict) else None
    return int(number) if isinstance(number, (int, float)) else 0


def refuse_newer(where: str, number: int) -> None:
    """Refuse data that a newer program has changed.

    Raises:
        DbError: STORE_NEWER.
    """
    if number > NEWEST:
        raise DbError(NewerSchema(where, number, version(), NEWEST))
