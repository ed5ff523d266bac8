"""Addresses and errors of the store: no password gets out, each error says what to do."""

from datetime import datetime

import bson
import pytest
from pymongo.errors import (
    AutoReconnect,
    DuplicateKeyError,
    NetworkTimeout,
    OperationFailure,
    PyMongoError,
    ServerSelectionTimeoutError,
)

from tms_db import store
from tms_reason.errors import ConfigError, DbError


@pytest.mark.parametrize(
    ("uri", "shown"),
    [
        ("mongodb://127.0.0.1:27117/?directConnection=true", "mongodb://127.0.0.1:27117"),
        ("mongodb://anna:s3cret@db1,db2:27017/rostmsdb?replicaSet=a", "mongodb://db1,db2:27017"),
        ("mongodb://anna:s3@cret@db1", "mongodb://db1"),
        ("mongodb+srv://anna:s3cret@db.example", "mongodb+srv://db.example"),
        ("s3cret", "(store address)"),
    ],
)
def test_redact(uri: str, shown: str) -> None:
    assert store.redact(uri) == shown


@pytest.mark.parametrize(
    "uri",
    [
        "s3cret",
        "http://anna:s3cret@db1",
        "mongodb://anna:s3cret@",
        "mongodb://anna:s3@cret@db1:27017",
        "mongodb://anna:s3cret@db1:port",
        "mongodb://anna:s3cret@db1/?authMechanism=none",
        "mongodb://anna:s3/cret@db1:27017",
    ],
)
def test_wrong_address_is_refused_without_its_password(uri: str) -> None:
    with pytest.raises(ConfigError) as caught:
        store.connect(uri, "rostmsdb")
    error: BaseException | None = caught.value
    assert "TMS_MONGODB_URI" in str(error)
    while error is not None:  # a traceback would show the causes, too
        assert "cret" not in str(error)
        error = error.__cause__ or (None if error.__suppress_context__ else error.__context__)


@pytest.mark.parametrize("option", ["tlsCAFile", "tlsCertificateKeyFile"])
def test_a_file_of_tls_that_is_missing_is_named(option: str) -> None:
    with pytest.raises(ConfigError, match=r"/nowhere/x\.pem cannot be used \(No such file") as caught:
        store.connect(f"mongodb://anna:s3cret@db1/?tls=true&{option}=/nowhere/x.pem", "rostmsdb")
    assert "cret" not in str(caught.value)


@pytest.mark.parametrize(("given", "retries"), [("", False), ("/?retryWrites=true", True), ("/?replicaSet=rs0", True)])
def test_writes_wait_for_the_disk_and_retry_only_if_asked(given: str, retries: bool) -> None:
    db = store.connect(f"mongodb://127.0.0.1:1{given}", "rostmsdb")
    assert db.write_concern.document == {"w": "majority", "j": True, "wtimeout": 3000}
    assert db.client.options.retry_writes is retries
    assert db.client.options.pool_options.socket_timeout == 3.0
    db.client.close()


@pytest.mark.parametrize(
    ("error", "code", "says"),
    [
        (AutoReconnect("x"), "STORE_DOWN", "tms start tms:store"),
        (NetworkTimeout("x"), "STORE_DOWN", "in 3.0 s: see whether its disk is full"),
        (ServerSelectionTimeoutError("x"), "STORE_DOWN", "does not answer"),
        (OperationFailure("x", 18), "STORE_DOWN", "TMS_MONGODB_URI"),
        (AutoReconnect("db1: SSL handshake failed: db1:27017"), "STORE_DOWN", "TLS with it fails"),
        (ServerSelectionTimeoutError("No replica set members match selector"), "STORE_DOWN", "start more of them"),
        (OperationFailure("x", 14031), "STORE_FULL", "disk is full"),
        (OperationFailure("x", 8, {"errmsg": "write: No space left on device"}), "STORE_FULL", "disk is full"),
        (OperationFailure("x", 9, {"errmsg": "odd\nthing"}), "STORE_REFUSED", r"\(odd\)"),
        (PyMongoError("x"), "DB_FAILED", "PyMongoError"),
    ],
)
def test_errors_say_what_to_do(error: PyMongoError, code: str, says: str) -> None:
    with pytest.raises(DbError, match=says) as caught, store.errors():
        raise error
    assert caught.value.code == code


def test_a_duplicate_key_is_for_the_repository() -> None:
    with pytest.raises(DuplicateKeyError), store.errors():
        raise DuplicateKeyError("x")


LATE = bson.encode({"a": datetime(2026, 1, 31)})[:-9] + (2**62).to_bytes(8, "little") + b"\0"
FOREIGN = bson.encode({"a": "xx"}).replace(b"xx\0", b"\xff\xfe\0")


@pytest.mark.parametrize("stored", [FOREIGN, LATE], ids=["text", "date"])
def test_a_document_that_cannot_be_decoded_is_told(stored: bytes) -> None:
    with pytest.raises(DbError, match=r"a stored document cannot be read \(.+\): correct or remove it") as caught:
        with store.errors():
            bson.decode(stored)
    assert caught.value.code == "BAD_RECORD"
    assert len(str(caught.value)) < 300
