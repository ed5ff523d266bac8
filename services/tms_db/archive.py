"""Files in the archive format of mongodump and mongorestore (`--archive`), written and read piece by piece.

After a magic number come a header, one description of each collection, and then the documents in segments: the
collection's name, its documents, a terminator. The last segment of a collection is empty and holds a checksum.
The specification is common/archive/spec.md of MongoDB's Database Tools.
"""

import gzip
import struct
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, cast

import bson
from bson import json_util
from bson.errors import BSONError
from bson.int64 import Int64
from fastcrc import crc64

from tms_db.reasons import (
    ArchiveChecksum,
    ArchiveCut,
    ArchiveDocument,
    ArchiveEnds,
    ArchiveFormat,
    ArchiveMisplaced,
    ArchiveMissing,
    ArchiveNoBson,
    ArchiveNoFile,
    ArchiveNoName,
    ArchiveNoRegular,
    ArchivePacked,
    ArchiveUnreadable,
    ArchiveWrong,
    ArchiveWrongAt,
    NoArchive,
)
from tms_reason.errors import DbError
from tms_reason.reason import Reason

MAGIC = bytes.fromhex("6de29981")
GZIP = b"\x1f\x8b"
END = b"\xff\xff\xff\xff"  # terminator of a segment
FORMAT = "0.1"
SMALLEST = 5  # bytes of a document
LARGEST = 16 * 2**20 + 16 * 2**10  # what a MongoDB server takes at most, with its overhead

Name = tuple[str, str]  # database and collection


def bad(what: Reason) -> DbError:
    """An archive that cannot be used."""
    return DbError(what, "BAD_ARCHIVE")


class Writer:
    """Writes one database."""

    def __init__(self, file: BinaryIO, database: str, server: str, tool: str) -> None:
        self._file, self._database = file, database
        self._put(MAGIC)
        self._document({"concurrent_collections": 1, "version": FORMAT, "server_version": server, "tool_version": tool})

    def describe(self, collections: Mapping[str, Sequence[Mapping[str, Any]]]) -> None:
        """Write the descriptions of the collections that follow, each with its indexes as the server lists them."""
        for name, indexes in collections.items():
            metadata = {"indexes": list(indexes), "collectionName": name, "type": "collection"}
            text = json_util.dumps(metadata, json_options=json_util.CANONICAL_JSON_OPTIONS)
            self._document(
                {"db": self._database, "collection": name, "metadata": text, "size": 0, "type": "collection"}
            )
        self._put(END)

    def collection(self, name: str, documents: Iterator[bytes]) -> None:
        """Write all documents of a collection; they are BSON."""
        crc, begun = 0, False
        for document in documents:
            if not begun:
                self._segment(name, 0, last=False)
                begun = True
            crc = crc64.xz(document, crc)
            self._put(document)
        if begun:
            self._put(END)
        self._segment(name, signed(crc), last=True)
        self._put(END)

    def _segment(self, name: str, crc: int, last: bool) -> None:
        self._document({"db": self._database, "collection": name, "EOF": last, "CRC": Int64(crc)})

    def _document(self, document: Mapping[str, Any]) -> None:
        self._put(bson.encode(document))

    def _put(self, data: bytes) -> None:
        self._file.write(data)


def signed(crc: int) -> int:
    """A checksum (CRC-64/ECMA as Go has it, which is the one of xz) as the signed 64-bit number that BSON holds."""
    return crc - 2**64 if crc >> 63 else crc


class Reader:
    """Reads and checks an archive; every fault raises a DbError BAD_ARCHIVE with file and place."""

    def __init__(self, path: Path, file: BinaryIO, plain: BinaryIO) -> None:
        """`plain` is the file itself; `file` is the stream to read: the same file, or its decompressed content."""
        self._path, self._file, self._plain = path, file, plain
        self._at = 0  # bytes read, after decompression
        if self._bytes(len(MAGIC)) != MAGIC:
            raise self._wrong(NoArchive())
        self.header = self._decoded(self._document())
        if self.header.get("version") != FORMAT:
            raise self._wrong(ArchiveFormat(str(self.header.get("version")), str(FORMAT)))
        self.names: list[Name] = []
        while (found := self._document()) is not None:
            self.names.append(self._name(self._decoded(found)))

    def documents(self) -> Iterator[tuple[Name, bytes]]:
        """Every document with its collection, in the order of the file."""
        sums: dict[Name, int] = {}
        ended: set[Name] = set()
        while (found := self._document(may_end=True)) is not None:
            head = self._decoded(found)
            name = self._name(head)
            if name in ended or name not in self.names:
                raise self._wrong(ArchiveMisplaced(".".join(name)))
            while (document := self._document()) is not None:
                self._decoded(document)
                sums[name] = crc64.xz(document, sums.get(name, 0))
                yield name, document
            if head.get("EOF"):
                ended.add(name)
                if signed(sums.get(name, 0)) != head.get("CRC"):
                    raise self._wrong(ArchiveChecksum(".".join(name)))
        missing = [".".join(name) for name in self.names if name not in ended]
        if missing:
            raise self._wrong(ArchiveCut(str(missing[0])))

    def share(self) -> float:
        """How much of the file has been read, 0 to 1."""
        return self._plain.tell() / max(1, self._path.stat().st_size)

    def _name(self, document: Mapping[str, Any]) -> Name:
        name = document.get("db"), document.get("collection")
        if not all(isinstance(part, str) and part for part in name):
            raise self._wrong(ArchiveNoName())
        return cast(Name, name)

    def _document(self, may_end: bool = False) -> bytes | None:
        """The next document; None at the end of a segment, or of the file where that is allowed."""
        first = self._bytes(4, may_end)
        if not first or first == END:
            return None
        (size,) = struct.unpack("<i", first)
        if not SMALLEST <= size <= LARGEST:
            raise self._wrong(ArchiveDocument(size))
        return first + self._bytes(size - 4)

    def _decoded(self, document: bytes | None) -> dict[str, Any]:
        if document is None:
            raise self._wrong(ArchiveMissing())
        try:
            return bson.decode(document)
        except BSONError as error:
            raise self._wrong(ArchiveNoBson()) from error

    def _bytes(self, count: int, may_end: bool = False) -> bytes:
        try:
            data = self._file.read(count)
        except (EOFError, gzip.BadGzipFile, zlib.error) as error:
            raise self._wrong(ArchivePacked(str(error))) from error
        if len(data) < count and (data or not may_end):
            raise self._wrong(ArchiveEnds())
        self._at += len(data)
        return data

    def _wrong(self, what: Reason) -> DbError:
        file = str(self._path)
        return bad(ArchiveWrongAt(file, what, self._at) if self._at > len(MAGIC) else ArchiveWrong(file, what))


@contextmanager
def reading(path: Path) -> Iterator[Reader]:
    """Open an archive, compressed with gzip or not.

    Raises:
        DbError: BAD_ARCHIVE.
    """
    try:
        if not path.is_file():
            raise bad(ArchiveWrong(str(path), ArchiveNoRegular() if path.exists() else ArchiveNoFile()))
        with path.open("rb") as plain:
            compressed = plain.read(2) == GZIP
            plain.seek(0)
            file = cast(BinaryIO, gzip.GzipFile(fileobj=plain)) if compressed else plain
            yield Reader(path, file, plain)
    except OSError as error:
        raise bad(ArchiveWrong(str(path), ArchiveUnreadable(str(error.strerror or error)))) from error
