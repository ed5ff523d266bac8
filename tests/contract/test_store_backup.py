"""Backup and restore as archives of MongoDB's tools, the schema's version, and a database of the C++ system."""

import gzip
import json
import stat
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import datetime, timedelta, timezone
from itertools import count
from pathlib import Path
from typing import Any

import bson
import click
import pytest
from bson.int64 import Int64
from bson.objectid import ObjectId
from click.testing import CliRunner, Result
from fastcrc import crc64
from pymongo.collection import Collection
from pymongo.errors import AutoReconnect

from tms_cli.commands import db as verb
from tms_config.clock import utc_now
from tms_db import archive, backup, schema, store
from tms_db.archive import signed
from tms_db.history import Event, History, Run
from tms_db.parameters import Parameters, RecordEdit
from tms_db.tasks import Tasks
from tms_db.terrain import Terrain
from tms_reason.errors import DbError, TmsError
from tms_reason.reason import Foreign

BEGIN = datetime(2026, 1, 31, 6, 0, tzinfo=timezone.utc)
SEQUENCE = '<root><BehaviorTree ID="old"><AlwaysSuccess/></BehaviorTree></root>'

# As the C++ system and its tools write them: plain ints, int64 and doubles mixed, nested messages, no version.
CPP: dict[str, list[dict[str, Any]]] = {
    "task": [
        {"_id": ObjectId(), "task_id": 1, "type": "task", "model_name": "zx200,ic120",
         "description": "No Commented ...", "task_sequence": SEQUENCE},
        {"_id": ObjectId(), "task_id": 7, "type": "task", "model_name": "", "description": "",
         "task_sequence": SEQUENCE.replace("old", "other")},
    ],
    "parameter": [
        {"_id": ObjectId(), "model_name": "zx200", "type": "static", "record_name": "initial_pose",
         "description": "...", "trajectory": 1, "swing_joint": -1.571, "boom_joint": -1.047, "bucket_end_joint": 0,
         "count": Int64(4)},
        {"_id": ObjectId(), "model_name": "zx200", "type": "dynamic", "record_name": "target_excavate_pose",
         "x": 0.0798, "theta_w": 0, "LOCK_FLG": False},
        {"_id": ObjectId(), "model_name": "ic120", "type": "static", "record_name": "PATH", "x": [1, 2, 3], "y": []},
        {"_id": ObjectId(), "record_name": "GLOBAL_BLACKBOARD", "R1n": True, "N": 3, "timestamps": BEGIN},
    ],
    "machine_pose": [
        {"_id": ObjectId(), "time": "2025-08-01T10:00:00.5", "type": "machine_pose", "id": 3012, "name": "zx200_1",
         "msg": {"header": {"frame_id": "world"}, "pose": {"position": {"x": 1.5}}}},
    ],
    "now": [{"_id": ObjectId(), "id": 3012, "name": "zx200_1", "msg": "{}"}],
    "default": [],
}  # fmt: skip


def silent(_: str) -> None:
    """Nobody watches."""


def fill(db: store.Db, documents: dict[str, list[dict[str, Any]]] = CPP) -> None:
    for name, rows in documents.items():
        if rows:
            db[name].insert_many([dict(row) for row in rows])


def content(db: store.Db) -> dict[str, list[bytes]]:
    """Every document byte by byte."""
    names = [name for name in db.list_collection_names() if name != schema.COLLECTION]
    rows = {name: sorted(bson.encode(row) for row in db[name].find()) for name in names}
    return {name: found for name, found in rows.items() if found}


def foreign(
    documents: dict[str, list[dict[str, Any]]], database: str = "rostmsdb", tool: str = "100.9.4", **damage: Any
) -> bytes:
    """An archive put together from the specification alone, interleaved as several threads of mongodump do it."""

    def part(**fields: Any) -> bytes:
        return bson.encode(fields)

    end = b"\xff\xff\xff\xff"
    data = bytearray(bytes.fromhex("6de29981"))
    data += part(concurrent_collections=4, version=damage.get("version", "0.1"), server_version="6.0.5",
                 tool_version=tool)  # fmt: skip
    for name in documents:
        metadata = '{"indexes":[{"v":{"$numberInt":"2"},"key":{"_id":{"$numberInt":"1"}},"name":"_id_"}]}'
        data += part(db=database, collection=name, metadata=metadata, size=0, type="collection")
    data += end
    for turn in range(max(map(len, documents.values()), default=0)):
        for name, rows in documents.items():
            if turn < len(rows):
                data += part(db=database, collection=name, EOF=False, CRC=Int64(0)) + bson.encode(rows[turn]) + end
    for name, rows in documents.items():
        crc = signed(crc64.xz(b"".join(map(bson.encode, rows))))
        data += part(db=database, collection=name, EOF=True, CRC=Int64(crc + damage.get("crc", 0))) + end
    return bytes(data)


def refusal(call: Callable[[], Any]) -> tuple[str, str]:
    with pytest.raises(TmsError) as caught:
        call()
    assert "\n" not in str(caught.value)
    return caught.value.code, str(caught.value)


@pytest.fixture
def other_db(server: Any) -> Iterator[store.Db]:
    """A second, empty database: where a backup goes on another PC."""
    db = server.open("other")
    yield db
    db.client.drop_database(db)
    server.forget(db)


@pytest.mark.parametrize("pieces", [[b"123456789"], [b"1", b"234", b"", b"56789"]])
def test_the_checksum_is_the_published_one(pieces: list[bytes]) -> None:
    crc = 0
    for piece in pieces:
        crc = crc64.xz(piece, crc)
    assert crc == 0x995DC9BBDF1939FA  # CRC-64/XZ in the catalogue of parametrised CRC algorithms
    assert signed(crc) == 0x995DC9BBDF1939FA - 2**64 and signed(1) == 1


def test_what_is_backed_up_comes_back_byte_by_byte(shared_db: store.Db, other_db: store.Db, tmp_path: Path) -> None:
    fill(shared_db)
    schema.bring_up(shared_db)
    run = Run("r1", 4, "text", "success", "", ("zx200",), BEGIN, BEGIN)
    history = [Event("r1", n, BEGIN, "node", values={"x.y": 1.5}) for n in range(1, 1200)]
    for first in range(0, len(history), 100):  # on a busy PC, the store would not answer one large write in time
        History(shared_db).write([run], history[first : first + 100])
    Tasks(shared_db).add('<root><BehaviorTree ID="new"><AlwaysSuccess/></BehaviorTree></root>')
    file = tmp_path / "b.archive"
    said: list[str] = []
    report = backup.backup(shared_db, file, said.append)
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert list(tmp_path.iterdir()) == [file]
    assert report.documents["event"] == 1199
    assert "event: 1199 of 1199" in said
    assert backup.restore(other_db, file, silent).documents == report.documents
    assert content(other_db) == content(shared_db)
    assert schema.stored(other_db) == schema.NEWEST
    assert len(History(other_db).events("r1", limit=5000)) == 1199
    indexes = {name: sorted(other_db[name].index_information()) for name in store.INDEXES}
    assert indexes == {name: sorted(shared_db[name].index_information()) for name in store.INDEXES}
    assert not [name for name in other_db.list_collection_names() if name.startswith(backup.STAGED)]


def test_terrain_comes_back_with_its_indexes_and_whole_though_some_is_added_meanwhile(
    shared_db: store.Db, other_db: store.Db, tmp_path: Path
) -> None:
    schema.bring_up(shared_db)
    terrain, later = Terrain(shared_db), ["later"]
    terrain.put("early", "dynamic", b"1" * 300_000, {})

    def say(text: str) -> None:
        if text.startswith("fs.") and later:
            terrain.put(later.pop(), "dynamic", b"2" * 300_000, {})

    backup.backup(shared_db, tmp_path / "b.archive", say)
    backup.restore(other_db, tmp_path / "b.archive", silent)
    restored = Terrain(other_db)
    assert not later
    assert [(file.filename, len(restored.read(file))) for file in restored.all()] == [("early", 300_000)]
    for name in store.GRIDFS:
        assert other_db[name].index_information() == shared_db[name].index_information()
    restored.put("new", "dynamic", b"3", {})


def test_a_backup_has_the_form_that_mongorestore_reads(shared_db: store.Db, tmp_path: Path) -> None:
    """Read back by hand, after the specification."""
    fill(shared_db)
    file = tmp_path / "b.archive"
    backup.backup(shared_db, file, silent)
    data = file.read_bytes()
    assert data[:4] == bytes([0x6D, 0xE2, 0x99, 0x81])
    blocks: list[list[dict[str, Any]]] = [[]]
    raw: dict[str, bytes] = {}
    at = 4
    while at < len(data):
        if data[at : at + 4] == b"\xff\xff\xff\xff":
            blocks.append([])
            at += 4
            continue
        size = int.from_bytes(data[at : at + 4], "little")
        blocks[-1].append(bson.decode(data[at : at + size]))
        if len(blocks) > 1 and len(blocks[-1]) > 1:
            name = blocks[-1][0]["collection"]
            raw[name] = raw.get(name, b"") + data[at : at + size]
        at += size
    (header, *described), *segments, nothing = blocks
    assert nothing == []
    assert (header["version"], header["concurrent_collections"]) == ("0.1", 1)
    assert all(set(one) == {"db", "collection", "metadata", "size", "type"} for one in described)
    index = json.loads(next(one["metadata"] for one in described if one["collection"] == "task"))["indexes"]
    assert {"task_id_1", "_id_"} <= {one["name"] for one in index}
    ends = {segment[0]["collection"]: segment[0] for segment in segments if segment[0]["EOF"]}
    assert set(ends) == {one["collection"] for one in described}
    for name, end in ends.items():
        assert end["CRC"] == signed(crc64.xz(raw.get(name, b"")))
    assert len(blocks[1]) - 1 == len([row for row in content(shared_db).get(blocks[1][0]["collection"], [])])


@pytest.mark.parametrize("compressed", [False, True])
def test_a_database_of_the_cpp_system_is_taken_over_unchanged(
    shared_db: store.Db, tmp_path: Path, compressed: bool
) -> None:
    file = tmp_path / "rostmsdb.archive"
    data = foreign(CPP)
    file.write_bytes(gzip.compress(data) if compressed else data)
    report = backup.restore(shared_db, file, silent)
    assert report.documents == {name: len(rows) for name, rows in CPP.items()}
    assert content(shared_db) == {name: sorted(map(bson.encode, rows)) for name, rows in CPP.items() if rows}
    works_on_cpp_documents(shared_db)


def test_starting_on_a_database_of_the_cpp_system_changes_no_document(db: store.Db) -> None:
    for name, rows in CPP.items():
        db[name].drop()
        if rows:
            db[name].insert_many([dict(row) for row in rows])
    assert len(schema.bring_up(db)) == schema.NEWEST
    assert content(db) == {name: sorted(map(bson.encode, rows)) for name, rows in CPP.items() if rows}
    works_on_cpp_documents(db)


def works_on_cpp_documents(db: store.Db) -> None:
    assert [task.task_id for task in Tasks(db).all()] == [1, 7]
    assert Tasks(db).get(7).task_sequence == SEQUENCE.replace("old", "other")
    assert Tasks(db).add(SEQUENCE).already_stored
    assert Parameters(db).get("zx200", "initial_pose")["swing_joint"] == -1.571
    assert Parameters(db).get("", "GLOBAL_BLACKBOARD")["N"] == 3
    assert History(db).runs() == []


def test_migrations_run_once_and_fill_what_older_documents_lack(db: store.Db) -> None:
    db["run"].insert_one({"run_id": "r1", "started_at": BEGIN, "ended_at": BEGIN})
    assert len(schema.bring_up(db)) == schema.NEWEST
    filled = db["run"].find_one({"run_id": "r1"}) or {}
    assert (filled["records"], filled["values"]) == ([], [])
    assert schema.bring_up(db) == []
    assert schema.stored(db) == schema.NEWEST


def test_a_migration_that_was_cut_off_is_done_again(db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []

    def step(db: store.Db) -> None:
        calls.append("step")
        if len(calls) == 1:
            raise DbError(Foreign("away"), "STORE_DOWN")

    monkeypatch.setattr(schema, "MIGRATIONS", (*schema.MIGRATIONS, schema.Migration("next", step)))
    monkeypatch.setattr(schema, "NEWEST", schema.NEWEST + 1)
    assert refusal(lambda: schema.bring_up(db))[0] == "STORE_DOWN"
    assert schema.stored(db) == schema.NEWEST - 1
    assert schema.bring_up(db) == [f"schema {schema.NEWEST}: next"]
    assert calls == ["step", "step"]


def test_a_newer_schema_is_refused(db: store.Db) -> None:
    db[schema.COLLECTION].insert_one({"_id": "tms", "version": schema.NEWEST + 1})
    code, text = refusal(lambda: schema.bring_up(db))
    assert code == "STORE_NEWER"
    assert f"has schema {schema.NEWEST + 1}, this program" in text
    assert "Install the newer program, or restore a backup from before" in text


# what restore refuses; the database stays as it was


def damaged(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 0x40]) + data[at + 1 :]


GOOD = foreign(CPP)
WRONG = {
    "empty": (b"", "BAD_ARCHIVE", "ends in the middle"),
    "text": (b"<root/> and more", "BAD_ARCHIVE", "is no archive of mongodump (wrong first bytes)"),
    "bson": (bson.encode(CPP["task"][0]), "BAD_ARCHIVE", "wrong first bytes"),
    "version": (foreign(CPP, version="0.2"), "BAD_ARCHIVE", "archive format '0.2'"),
    "cut in a document": (GOOD[:-300], "BAD_ARCHIVE", "the file was cut off"),
    "cut between segments": (GOOD[: GOOD.rindex(b"\xff\xff\xff\xff", 0, -4) + 4], "BAD_ARCHIVE", "is complete"),
    "cut in its head": (GOOD[:100], "BAD_ARCHIVE", "cut off"),
    "checksum": (foreign(CPP, crc=1), "BAD_ARCHIVE", "the checksum of rostmsdb."),
    "flipped bit": (damaged(GOOD, GOOD.index(b"AlwaysSuccess")), "BAD_ARCHIVE", "the checksum of rostmsdb.task"),
    "size": (GOOD[:4] + b"\x7f\xff\xff\x7f" + GOOD[8:], "BAD_ARCHIVE", "a document of 2147483519 bytes"),
    "gzip cut": (gzip.compress(GOOD)[:-200], "BAD_ARCHIVE", "cannot be decompressed"),
    "gzip damaged": (b"\x1f\x8b" + b"x" * 40, "BAD_ARCHIVE", "cannot be decompressed"),
    "other database": (foreign({"films": [{"_id": 1}]}, "cinema"), "NOT_TMS", "neither task nor parameter"),
    "other tasks": (foreign({"task": [{"_id": 1, "due": 5}]}, "todo"), "NOT_TMS", "has no task_id"),
    "other parameters": (foreign({"parameter": [{"_id": 1}]}), "NOT_TMS", "document 1 of parameter has no record_name"),
    "nothing": (foreign({}), "NOT_TMS", "holds no database"),
    "newer": (foreign({**CPP, "schema": [{"_id": "tms", "version": 99}]}), "STORE_NEWER", "has schema 99"),
    "two of one key": (
        foreign({"parameter": [{"_id": n, "model_name": "zx200", "record_name": "pose"} for n in (1, 2)]}),
        "STORE_CONFLICT", "collection parameter: two documents with the same key",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_archive_changes_nothing(shared_db: store.Db, tmp_path: Path, name: str) -> None:
    data, code, says = WRONG[name]
    file = tmp_path / "wrong.archive"
    file.write_bytes(data)
    shared_db["task"].insert_one({"task_id": 5, "task_sequence": SEQUENCE})
    before = content(shared_db)
    found, text = refusal(lambda: backup.restore(shared_db, file, silent, drop=True))
    assert (found, says in text) == (code, True), text
    assert content(shared_db) == before
    assert not [one for one in shared_db.list_collection_names() if one.startswith(backup.STAGED)]


def test_a_database_with_content_is_replaced_only_when_asked(shared_db: store.Db, tmp_path: Path) -> None:
    file = tmp_path / "a.archive"
    file.write_bytes(GOOD)
    shared_db["task"].insert_one({"task_id": 5, "task_sequence": SEQUENCE})
    shared_db["extra"].insert_one({"a": 1})
    code, text = refusal(lambda: backup.restore(shared_db, file, silent))
    assert (code, "is not empty (1 extra, 1 task): --drop" in text) == ("NOT_EMPTY", True)
    shared_db["run"].insert_one({"run_id": "r9", "ended_at": None})
    code, text = refusal(lambda: backup.restore(shared_db, file, silent, drop=True))
    assert (code, "run r9 is active" in text) == ("RUN_ACTIVE", True)
    shared_db["run"].update_one({"run_id": "r9"}, {"$set": {"ended_at": BEGIN}})
    backup.restore(shared_db, file, silent, drop=True)
    assert content(shared_db) == {name: sorted(map(bson.encode, rows)) for name, rows in CPP.items() if rows}


def test_one_of_several_databases_is_chosen_by_name(shared_db: store.Db, tmp_path: Path) -> None:
    file = tmp_path / "a.archive"
    both = bytearray(GOOD)
    head, *_ = (bytes(GOOD[:4] + bson.encode(bson.decode_all(GOOD[4 : 4 + GOOD[4]])[0])),)
    described = bson.encode({"db": "admin", "collection": "system.version", "metadata": "{}", "size": 0})
    both[len(head) : len(head)] = described
    both += bson.encode({"db": "admin", "collection": "system.version", "EOF": True, "CRC": Int64(0)}) + b"\xff" * 4
    file.write_bytes(both)
    assert backup.check(file, "rostmsdb", silent).documents["task"] == 2
    file.write_bytes(both.replace(b"\x00admin\x00", b"\x00other\x00"))
    code, text = refusal(lambda: backup.check(file, "mine", silent))
    assert (code, "holds no database mine (there: other, rostmsdb)" in text) == ("NOT_TMS", True)


def test_files_that_cannot_be_used(shared_db: store.Db, tmp_path: Path) -> None:
    there = tmp_path / "there"
    there.write_bytes(b"precious")
    assert refusal(lambda: backup.backup(shared_db, there, silent))[0] == "FILE_EXISTS"
    assert refusal(lambda: backup.backup(shared_db, tmp_path, silent, overwrite=True))[0] == "FILE_EXISTS"
    assert there.read_bytes() == b"precious"
    code, text = refusal(lambda: backup.backup(shared_db, tmp_path / "no" / "b", silent))
    assert (code, "No such file" in text) == ("NO_FILE", True)
    assert "there is no such file" in refusal(lambda: backup.check(tmp_path / "none", "rostmsdb", silent))[1]
    assert "is no regular file" in refusal(lambda: backup.check(tmp_path, "rostmsdb", silent))[1]
    backup.backup(shared_db, there, silent, overwrite=True)
    with archive.reading(there) as reader:
        assert reader.header["tool_version"].startswith("tms ")


def test_a_backup_that_breaks_leaves_no_file(own_server: Any, tmp_path: Path) -> None:
    db = own_server.open()
    fill(db)

    def die(_: str) -> None:
        own_server.end(kill=True)
        raise DbError(Foreign("the store went away"), "STORE_DOWN")

    assert refusal(lambda: backup.backup(db, tmp_path / "b.archive", die))[0] == "STORE_DOWN"
    assert [path.name for path in tmp_path.iterdir() if path.name != "store"] == []
    db.client.close()


def test_a_restore_that_breaks_leaves_the_database_as_it_was(
    shared_db: store.Db, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.archive"
    file.write_bytes(GOOD)
    shared_db["task"].insert_one({"task_id": 5, "task_sequence": SEQUENCE})
    before = content(shared_db)

    def say(text: str) -> None:
        if text.startswith("writing"):
            raise DbError(Foreign("the store's disk is full"), "STORE_FULL")

    assert refusal(lambda: backup.restore(shared_db, file, say, drop=True))[0] == "STORE_FULL"
    assert content(shared_db) == before
    assert not [one for one in shared_db.list_collection_names() if one.startswith(backup.STAGED)]
    backup.restore(shared_db, file, silent, drop=True)
    assert [task.task_id for task in Tasks(shared_db).all()] == [1, 7]


def test_a_run_that_was_active_at_the_backup_is_abandoned_by_the_restore(
    shared_db: store.Db, other_db: store.Db, tmp_path: Path
) -> None:
    fill(shared_db)
    schema.bring_up(shared_db)
    ended = Run("r1", 4, "text", "success", "", ("zx200",), BEGIN, BEGIN)
    active = Run("r2", 4, "text", "running", "", ("zx200",), BEGIN, None, ("zx200/initial_pose",))
    History(shared_db).write([ended, active], [Event("r2", 1, BEGIN, "node")])
    with pytest.raises(DbError, match="run r2 uses it"):
        Parameters(shared_db).set("zx200", "initial_pose", RecordEdit({"trajectory": 2}))
    file = tmp_path / "b.archive"
    backup.backup(shared_db, file, silent)
    backup.restore(other_db, file, silent)
    runs = {run.run_id: run for run in History(other_db).runs()}
    assert runs["r1"] == ended
    closed = runs["r2"]
    assert (closed.state, closed.reason) == ("abandoned", "restored from a backup")
    assert closed.ended_at is not None
    assert abs(utc_now() - closed.ended_at) < timedelta(minutes=1)
    assert replace(closed, state="running", reason="", ended_at=None) == active
    Parameters(other_db).set("zx200", "initial_pose", RecordEdit({"trajectory": 2}))  # static, and locked by no run
    backup.restore(other_db, file, silent, drop=True)


def test_a_store_that_is_lost_while_collections_change_places_is_told_as_such(
    shared_db: store.Db, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.archive"
    file.write_bytes(GOOD)
    shared_db["task"].insert_one({"task_id": 5, "task_sequence": SEQUENCE})
    rename, calls = Collection.rename, count(1)

    def lost(self: Collection[Any], *given: Any, **more: Any) -> Any:
        if next(calls) == 3:
            raise AutoReconnect("connection closed")
        return rename(self, *given, **more)

    monkeypatch.setattr(Collection, "rename", lost)
    code, text = refusal(lambda: backup.restore(shared_db, file, silent, drop=True))
    assert code == "STORE_DOWN"
    assert "the store does not answer" in text
    assert "replaced only in part: run the same restore with --drop again" in text
    backup.restore(shared_db, file, silent, drop=True)
    assert content(shared_db) == {name: sorted(map(bson.encode, rows)) for name, rows in CPP.items() if rows}
    assert not [one for one in shared_db.list_collection_names() if one.startswith(backup.STAGED)]


@pytest.fixture
def tms(shared_db: store.Db, server: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Verbs below `tms db` on a site with this store."""
    site = tmp_path / "site.yaml"
    site.write_text(
        f"{{name: test, domain: 43, store: {{kind: mongodb, database: {shared_db.name}}}, services: {{db: {{}}}}}}"
    )
    monkeypatch.setenv("TMS_MONGODB_URI", server.uri)
    monkeypatch.setenv("TMS_SITE", str(site))
    return lambda *words, **more: CliRunner().invoke(verb.command, [str(word) for word in words], **more)


def test_the_command_line(shared_db: store.Db, tmp_path: Path, tms: Callable[..., Result]) -> None:
    fill(shared_db)
    file = tmp_path / "b.archive"
    made = json.loads(tms("backup", file, "--json").stdout)
    assert (made["documents"]["parameter"], made["bytes"]) == (4, file.stat().st_size)
    shared_db["task"].delete_many({})
    assert "is not empty" in str(tms("restore", file).exception)
    asked = tms("restore", file, "--drop", input="n\n")
    assert isinstance(asked.exception, (click.Abort, SystemExit))
    assert "Replace all of database" in asked.output
    assert shared_db["task"].count_documents({}) == 0
    assert tms("restore", file, "--yes").exit_code == 2
    done = tms("restore", file, "--drop", "--yes")
    assert done.stdout.startswith(f"restored into {shared_db.name}: ")
    shown = json.loads(tms("info", "--json").stdout)
    assert (shown["documents"]["task"], shown["schema"]) == (2, schema.NEWEST)
    assert "@" not in shown["address"]
    assert f"schema {schema.NEWEST}" in tms("info").stdout
