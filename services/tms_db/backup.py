"""The whole database into an archive file and back; tools of MongoDB read and write the same files.

These functions open the store themselves, as mongodump does: a backup must not need a running system.
"""

import os
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, cast

import bson
from bson.codec_options import CodecOptions
from bson.raw_bson import RawBSONDocument
from pymongo.collection import Collection
from pymongo.errors import BulkWriteError

from tms_config.clock import utc_now
from tms_db import archive, schema, store
from tms_db.archive import Name
from tms_db.reasons import (
    FileExists,
    FileNotWritten,
    NoDatabaseIn,
    NoFieldIn,
    NotEmpty,
    NotOfTms,
    ReplacedInPart,
    RunActive,
)
from tms_db.store import Db, errors
from tms_reason.errors import DbError, TmsError
from tms_runtime.version import version

STAGED = "restoring."  # before the names of collections that are not complete yet
BATCH = 500  # documents
BATCH_BYTES = 4 * 2**20
# A run is written as ended after its events, a file of GridFS after its chunks: a backup that reads these first holds
# all that belongs to them.
FIRST = ("run", "fs.files")
DUPLICATE = 11000  # MongoDB's code of a unique key that is there already
RAW: CodecOptions[RawBSONDocument] = CodecOptions(document_class=RawBSONDocument)
NEEDED = {"task": ("task_id", "task_sequence"), "parameter": ("record_name",)}  # fields that identify a TMS database

Say = Callable[[str], None]


@dataclass(frozen=True)
class Contents:
    """What an archive holds, or a database."""

    database: str
    documents: dict[str, int]  # by collection
    schema: int

    @property
    def text(self) -> str:
        filled = [f"{number} {name}" for name, number in sorted(self.documents.items()) if number]
        return ", ".join(filled) or "nothing"


def describe(db: Db) -> Contents:
    """Report what the database holds.

    Raises:
        DbError: the store is away.
    """
    with errors():
        counts = {name: db[name].count_documents({}) for name in _collections(db)}
    counts.pop(schema.COLLECTION, None)
    return Contents(db.name, counts, schema.stored(db))


def backup(db: Db, path: Path, say: Say, *, overwrite: bool = False) -> Contents:
    """Write everything into a file that appears only when it is complete.

    Raises:
        DbError: the store is away.
        TmsError: the file is there already, or cannot be written.
    """
    if path.exists() and not (overwrite and path.is_file()):
        raise TmsError(FileExists(str(path)))
    before = describe(db)
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False) as file:  # mode 0600
            new = Path(file.name)
            try:
                counts = _dump(db, cast(BinaryIO, file), say)
                file.flush()
                os.fsync(file.fileno())
                new.replace(path)
            finally:
                new.unlink(missing_ok=True)
    except OSError as error:
        raise TmsError(FileNotWritten(str(path), str(error.strerror)), "NO_FILE") from error
    return Contents(db.name, counts, before.schema)


def _dump(db: Db, file: BinaryIO, say: Say) -> dict[str, int]:
    counts: Counter[str] = Counter()
    with errors():
        names = sorted(_collections(db), key=lambda name: (name not in FIRST, name))
        out = archive.Writer(file, db.name, str(db.client.server_info()["version"]), f"tms {version()}")
        out.describe({name: list(db[name].list_indexes()) for name in names})
        for name in names:
            total = db[name].estimated_document_count()

            def documents(name: str = name, total: int = total) -> Iterator[bytes]:
                raw = cast("Collection[RawBSONDocument]", db.get_collection(name, codec_options=RAW))
                for document in raw.find():
                    counts[name] += 1
                    say(f"{name}: {counts[name]} of {total}")
                    yield bytes(document.raw)

            out.collection(name, documents())
    return {name: counts[name] for name in names if name != schema.COLLECTION}


def check(path: Path, wanted: str, say: Say) -> Contents:
    """Read a whole archive without writing anything.

    `wanted` is the name of our database; a single database of another name is taken, too.

    Raises:
        DbError: BAD_ARCHIVE, NOT_TMS or STORE_NEWER.
    """
    counts: Counter[str] = Counter()
    number = 0
    with archive.reading(path) as reader:
        database = _choose(path, reader.names, wanted)
        for (of, collection), document in reader.documents():
            if of != database:
                continue
            counts[collection] += 1
            say(f"checking {path.name}: {reader.share():.0%}")
            if collection in NEEDED:
                _check(path, collection, counts[collection], bson.decode(document))
            elif collection == schema.COLLECTION:
                number = schema.number_of(bson.decode(document))
        schema.refuse_newer(str(path), number)
        names = [name for of, name in reader.names if of == database and _ours(name)]
        return Contents(database, {name: counts[name] for name in names if name != schema.COLLECTION}, number)


def restore(db: Db, path: Path, say: Say, *, drop: bool = False) -> Contents:
    """Put an archive's documents into the database, unchanged but for runs that were active at the time of the backup.

    The archive is read and checked first, then written into collections of other names; at the end these replace the
    present ones.

    Raises:
        DbError: the archive is wrong, the database is not empty (and not to be dropped), a run is active, or the
            store is away. The database is then as it was, unless the message says that it was replaced in part: the
            store was lost between two collections.
    """
    contents = check(path, db.name, say)
    there = describe(db)
    schema.refuse_newer(f"database {db.name}", there.schema)
    if any(there.documents.values()) and not drop:
        raise DbError(NotEmpty(db.name, there.text))
    with errors():
        active = db["run"].find_one({"ended_at": None}, {"run_id": 1}) if "run" in there.documents else None
    if active is not None:
        raise DbError(RunActive(str(active["run_id"]), db.name))
    names = [*contents.documents, *([schema.COLLECTION] if contents.schema else [])]
    try:
        _clear(db)
        _stage(db, path, contents.database, names, say)
        _abandon(db, names)
    except DbError:
        _clear(db)
        raise
    say("replacing")
    try:
        _exchange(db, names)
    except DbError as error:
        raise DbError(ReplacedInPart(error.reason, db.name), error.code) from error
    schema.bring_up(db)
    return contents


def _stage(db: Db, path: Path, database: str, names: list[str], say: Say) -> None:
    for name in names:
        with errors():
            db.create_collection(STAGED + name)
        store.index(db, name, STAGED + name)  # while it is empty: later it could take minutes
    with archive.reading(path) as reader:
        for collection, batch in _batches(reader, database):
            with errors():
                try:
                    db.get_collection(STAGED + collection, codec_options=RAW).insert_many(batch)
                except BulkWriteError as error:
                    first = error.details["writeErrors"][0]
                    if first.get("code") != DUPLICATE:
                        raise
                    raise store.conflict(db, collection, first.get("keyValue")) from error
            say(f"writing: {reader.share():.0%}")


def _abandon(db: Db, names: list[str]) -> None:
    """Close runs that were active at the backup: no process continues them, and an open one locks records for ever."""
    if "run" not in names:
        return
    end = {"state": "abandoned", "reason": "restored from a backup", "ended_at": utc_now()}
    with errors():
        db[STAGED + "run"].update_many({"ended_at": None}, {"$set": end})


def _batches(reader: archive.Reader, database: str) -> Iterator[tuple[str, list[RawBSONDocument]]]:
    batch: list[RawBSONDocument] = []
    size, of = 0, ""
    for (source, collection), document in reader.documents():
        if source != database or not _ours(collection):
            continue
        if batch and (collection != of or len(batch) >= BATCH or size >= BATCH_BYTES):
            yield of, batch
            batch, size = [], 0
        of = collection
        size += len(document)
        batch.append(RawBSONDocument(document))
    if batch:
        yield of, batch


def _exchange(db: Db, names: list[str]) -> None:
    with errors():
        for name in names:
            db[STAGED + name].rename(name, dropTarget=True)
        for name in _collections(db):
            if name not in names:
                db.drop_collection(name)


def _clear(db: Db) -> None:
    """Drop the collections that an unfinished restore has left."""
    with errors():
        for name in db.list_collection_names():
            if name.startswith(STAGED):
                db.drop_collection(name)


def _choose(path: Path, names: list[Name], wanted: str) -> str:
    databases = sorted({database for database, _ in names} - {"admin", "config", "local"})
    database = wanted if wanted in databases else databases[0] if len(databases) == 1 else ""
    if not database:
        held = ", ".join(databases) or "none"
        raise DbError(NoDatabaseIn(str(path), wanted, held), "NOT_TMS")
    there = sorted(name for of, name in names if of == database)
    if not set(NEEDED) & set(there):
        raise DbError(NotOfTms(str(path), database, tuple(there)), "NOT_TMS")
    return database


def _check(path: Path, collection: str, number: int, document: dict[str, Any]) -> None:
    missing = [field for field in NEEDED[collection] if field not in document]
    if missing:
        raise DbError(NoFieldIn(str(path), number, collection, missing[0]), "NOT_TMS")


def _collections(db: Db) -> list[str]:
    return [name for name in db.list_collection_names(filter={"type": "collection"}) if _ours(name)]


def _ours(name: str) -> bool:
    return not name.startswith(("system.", STAGED))
