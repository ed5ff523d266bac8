"""Opens the database: connection with short time-outs, unique indexes, and errors that a person can act on."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

import pymongo
from bson.errors import InvalidBSON
from pymongo import ASCENDING, DESCENDING, MongoClient
from pymongo.database import Database
from pymongo.errors import (
    ConfigurationError,
    ConnectionFailure,
    DocumentTooLarge,
    DuplicateKeyError,
    InvalidURI,
    NetworkTimeout,
    OperationFailure,
    PyMongoError,
)
from pymongo.uri_parser import parse_uri

from tms_db.reasons import (
    DocumentUnreadable,
    NoMember,
    NoPrimary,
    NoStore,
    NoVouching,
    StoreAddress,
    StoreDown,
    StoreFailed,
    StoreFile,
    StoreFull,
    StoreLogin,
    StoreRefused,
    StoreSilent,
    StoreUnusable,
    TlsFails,
    TooLarge,
    TwoWithOneKey,
    WantsCertificate,
)
from tms_reason.errors import ConfigError, DbError
from tms_reason.reason import Reason

Db = Database[dict[str, Any]]

FIND_SERVER_MS = 2000
ANSWER_MS = 3000
LONG = 60.0  # s for work on a whole collection: indexes, migrations
AUTH_CODES = {13, 18, 8000}  # Unauthorized, AuthenticationFailed, Atlas
HINTS: dict[str, Reason] = {  # part of the driver's text -> what is wrong and what to do
    "certificate verify failed": NoVouching(),
    "alert certificate required": WantsCertificate(),
    "SSL handshake failed": TlsFails(),
    "No replica set members match": NoPrimary(),
    "No primary available for writes": NoPrimary(),
    "No replica set members available": NoMember(),
}
DISK_CODES = {14031, 28}  # OutOfDiskSpace, ENOSPC passed on by an engine
SIZE_CODES = {10334, 17419, 17420}  # BSONObjectTooLarge, and what an update would make larger than allowed

# Collection -> (fields, unique). `sparse` lets tasks of the C++ system, which have no text hash, stand.
INDEXES: dict[str, list[tuple[list[tuple[str, int]], dict[str, Any]]]] = {
    "task": [
        ([("task_id", ASCENDING)], {"unique": True}),
        ([("text_sha256", ASCENDING)], {"unique": True, "sparse": True}),
    ],
    "subtask": [([("task_name", ASCENDING)], {})],  # not unique: the C++ system stores changed texts beside old ones
    "parameter": [
        ([("model_name", ASCENDING), ("record_name", ASCENDING)], {"unique": True}),
        ([("record_name", ASCENDING)], {}),  # the C++ system's reader asks without a model
    ],
    "run": [
        ([("run_id", ASCENDING)], {"unique": True}),
        ([("started_at", DESCENDING)], {}),
        ([("ended_at", ASCENDING)], {}),
    ],
    "parameter_history": [([("model_name", ASCENDING), ("record_name", ASCENDING)], {"unique": True})],
    "machine_pose": [([("time", DESCENDING)], {})],
    "machine_joints": [([("time", DESCENDING)], {})],
    "cycle": [
        ([("run_id", ASCENDING), ("machine", ASCENDING), ("number", ASCENDING)], {"unique": True}),
        ([("ended_at", ASCENDING)], {}),
    ],
    "event": [([("run_id", ASCENDING), ("number", ASCENDING)], {"unique": True})],
    "recording": [([("machine", ASCENDING), ("begin", ASCENDING)], {"unique": True}), ([("begin", ASCENDING)], {})],
}
# GridFS makes these with its first file, but not in collections that have files already, as after a restore.
GRIDFS: dict[str, list[tuple[list[tuple[str, int]], dict[str, Any]]]] = {
    "fs.files": [([("filename", ASCENDING), ("uploadDate", ASCENDING)], {})],
    "fs.chunks": [([("files_id", ASCENDING), ("n", ASCENDING)], {"unique": True})],
}


def redact(uri: str) -> str:
    """The URI without user, password and options, fit for a message or a log."""
    parts = urlsplit(uri)
    return f"{parts.scheme}://{parts.netloc.rpartition('@')[2]}" if parts.netloc else "(store address)"


def connect(uri: str, database: str, answer_ms: int = ANSWER_MS) -> Db:
    """The database behind `uri`; opens no connection yet. Call once a process.

    Args:
        uri: of MongoDB, with user and password where the server wants them.
        database: its name.
        answer_ms: time-out of one answer; commands by hand on a whole database take longer than a service.

    Raises:
        ConfigError: the URI is wrong; the message holds no password.
    """
    try:
        given = {key.lower() for key in parse_uri(uri)["options"]}
        # A single server has no second node to retry on, and a stand-alone mongod refuses retryable writes.
        retry: dict[str, Any] = {} if given & {"retrywrites", "replicaset"} else {"retryWrites": False}
        client: MongoClient[dict[str, Any]] = MongoClient(
            uri, w="majority", journal=True, wTimeoutMS=answer_ms, tz_aware=True,
            serverSelectionTimeoutMS=FIND_SERVER_MS, connectTimeoutMS=FIND_SERVER_MS, socketTimeoutMS=answer_ms,
            appname="tms_db", **retry,
        )  # fmt: skip
    except (InvalidURI, ConfigurationError, ValueError) as error:
        # pymongo's own text may quote the URI, so neither it nor the exception goes on.
        kind = type(error).__name__
        raise ConfigError(StoreAddress(redact(uri), kind)) from None
    except OSError as error:  # a file of tlsCAFile or tlsCertificateKeyFile
        file = error.filename or "a file of TLS"
        raise ConfigError(StoreFile(str(file), str(error.strerror))) from None
    return client[database]


def prepare(db: Db) -> None:
    """Create the unique indexes that are missing.

    Raises:
        DbError: STORE_DOWN, or STORE_CONFLICT when stored documents break a key.
    """
    for collection in INDEXES:
        index(db, collection)


def index(db: Db, collection: str, name: str = "") -> None:
    """Create the missing indexes of a collection; `name` is its temporary name during a restore.

    Raises:
        DbError: as `prepare`.
    """
    for fields, options in {**INDEXES, **GRIDFS}.get(collection, ()):
        try:
            with long_work(db):  # the first time, in a database of the C++ system
                db[name or collection].create_index(fields, **options)
        except DuplicateKeyError as error:
            key = (error.details or {}).get("keyValue") or " and ".join(name for name, _ in fields)
            raise conflict(db, collection, key) from error


def conflict(db: Db, collection: str, key: object) -> DbError:
    """The error for two documents where one is allowed."""
    return DbError(TwoWithOneKey(db.name, collection, str(key)))


@contextmanager
def long_work(db: Db) -> Iterator[None]:
    """Around steps that may take longer than an answer to a service; a store that is away still fails soon."""
    with errors():
        db["schema"].find_one({}, {"_id": 1})  # with LONG as time-out the driver would look for a server that long
        with pymongo.timeout(LONG):
            yield


@contextmanager
def errors() -> Iterator[None]:
    """Turn pymongo's errors into DbError; a duplicate key passes, since the caller knows what it means."""
    try:
        yield
    except DuplicateKeyError:
        raise
    except NetworkTimeout as error:  # connected but silent, as the embedded store with a full disk
        raise DbError(StoreDown(StoreSilent(ANSWER_MS / 1000))) from error
    except ConnectionFailure as error:
        raise _unreachable(str(error)) from error
    except DocumentTooLarge as error:
        raise _too_large() from error
    except OperationFailure as error:
        raise _refused(error) from error
    except InvalidBSON as error:  # other systems write here, too: text that is no UTF-8, an impossible date
        raise DbError(DocumentUnreadable(_first(error)), "BAD_RECORD") from error
    except PyMongoError as error:
        raise DbError(StoreFailed(type(error).__name__, "tms:db"), "DB_FAILED") from error


def down() -> DbError:
    """The error that the store does not answer."""
    return DbError(StoreDown(NoStore()))


def _unreachable(text: str) -> DbError:
    """The error that there is no connection, with the driver's text, which may be a page long."""
    hint = next((hint for part, hint in HINTS.items() if part in text), None)
    return DbError(StoreDown(StoreUnusable(hint))) if hint is not None else down()


def _first(reported: object) -> str:
    """As much of a text as fits into a message."""
    return str(reported).partition("\n")[0][:200]


def _too_large() -> DbError:
    return DbError(TooLarge())


def _refused(error: OperationFailure) -> DbError:
    details = error.details or {}
    first = (details.get("writeErrors") or [details])[0]  # among many writes, the one that the store refused
    code = first.get("code", error.code)
    text = _first(first.get("errmsg", type(error).__name__))
    if code in SIZE_CODES or "object to insert too large" in text:  # which has no code of its own in MongoDB
        return _too_large()
    if code in AUTH_CODES:
        return DbError(StoreDown(StoreLogin()))
    if code in DISK_CODES or "no space" in text.lower():
        return DbError(StoreFull())
    return DbError(StoreRefused(text, "tms:db"))
