"""What a folder of the C++ system holds: trees and records of its configuration, or the documents of a dump.

Read are `*.xml` (trees), `*.yaml` (records), and `task`, `subtask` and `parameter` as mongodump writes them
(`*.bson`, or an archive) or as MongoDB's tools export them (`*.json`). Uses no database.
"""

import gzip
import json
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bson
from bson import json_util
from bson.errors import BSONError

from tms_config.yaml_file import read_yaml
from tms_db import archive, task_text
from tms_db.reasons import (
    DocumentNotRead,
    DocumentTooLarge,
    ImportNothing,
    NoCollectionOfTasks,
    NoRecordsInFile,
    NoSuchSource,
    NoTreeInFile,
    UnreadableFile,
)
from tms_db.records import MAX_FILE, Document
from tms_reason import xml_text
from tms_reason.errors import TmsError
from tms_reason.reason import Reason

COLLECTIONS = {"task": "task", "subtask": "template", "parameter": "record"}  # -> what its documents are
MAX_DUMP = 200 * 2**20  # bytes of one file


@dataclass(frozen=True)
class Tree:
    """A tree out of a file or a document."""

    place: str
    text: str
    name: str  # of the file or the template
    document: Document | None = None  # of a dump
    kind: str = ""  # task or template; empty where the file does not say it


@dataclass(frozen=True)
class FoundRecord:
    """A record out of a file or a dump, as it stands there."""

    place: str
    document: Document
    dumped: bool = False


@dataclass(frozen=True)
class Unusable:
    """Something that is not imported."""

    place: str
    why: Reason


@dataclass
class Source:
    """All that was found, in the order of the names of the files."""

    trees: list[Tree] = field(default_factory=list)
    records: list[FoundRecord] = field(default_factory=list)
    refused: list[Unusable] = field(default_factory=list)  # broken
    others: list[Unusable] = field(default_factory=list)  # neither trees nor records


def read(path: Path) -> Source:
    """Read a folder with the folders in it, or an archive of mongodump.

    Raises:
        TmsError: there is no such folder or archive, or nothing in it that could be imported.
    """
    source = Source()
    if path.is_dir():
        _folder(source, path)
    elif path.is_file():
        _archive(source, path)
    else:
        raise TmsError(NoSuchSource(str(path)))
    if not (source.trees or source.records or source.refused):
        raise TmsError(ImportNothing(str(path)))
    return source


def _folder(source: Source, folder: Path) -> None:
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = Path(path.name.removesuffix(".gz"))  # mongodump --gzip
        reader = READERS.get(name.suffix.lower())
        if reader is None or name.match("*.metadata.json") or name.match("prelude.json"):
            continue
        place = str(path.relative_to(folder))
        try:
            reader(source, path, place)
        except TmsError as error:
            source.refused.append(Unusable(place, error.reason))
        except OSError as error:
            source.refused.append(Unusable(place, UnreadableFile(place, str(error.strerror))))


def _archive(source: Source, path: Path) -> None:
    numbers: Counter[str] = Counter()
    with archive.reading(path) as reader:
        for (database, collection), data in reader.documents():
            place = f"{database}.{collection}"
            numbers[place] += 1
            kind = COLLECTIONS.get(collection)
            if kind is not None:
                _document(source, kind, f"{place}, document {numbers[place]}", bson.decode(data))
            elif numbers[place] == 1:
                source.others.append(Unusable(place, NoCollectionOfTasks(collection)))


def _xml(source: Source, path: Path, place: str) -> None:
    text = task_text.read_file(path)
    root = xml_text.elements(xml_text.decode(text), comments=False)
    if root.tag != "root" or root.find("BehaviorTree") is None:
        source.others.append(Unusable(place, NoTreeInFile()))
        return
    source.trees.append(Tree(place, text, path.stem))


def _yaml(source: Source, path: Path, place: str) -> None:
    data: Any = None
    if path.stat().st_size <= MAX_FILE:
        try:
            data = read_yaml(path)
        except TmsError as error:  # files of other programs have tags that only these know
            source.others.append(Unusable(place, error.reason))
            return
    found = list(_records_of(data))
    if not found:
        source.others.append(Unusable(place, NoRecordsInFile()))
    source.records += [FoundRecord(f"{place}, record {number}", one) for number, one in enumerate(found, 1)]


def _records_of(data: Any) -> Iterator[Document]:
    """Records of a list as `tms param load` reads it, or of the C++ system's initial_values.yaml."""
    if isinstance(data, dict) and isinstance(data.get("initial_parameters"), list):
        for entry in data["initial_parameters"]:
            if isinstance(entry, dict) and isinstance(entry.get("values"), dict):
                yield {"record_name": entry.get("record_name"), "type": "dynamic", **entry["values"]}
    elif isinstance(data, list):
        yield from (entry for entry in data if isinstance(entry, dict) and "record_name" in entry)


def _bson(source: Source, path: Path, place: str) -> None:
    if kind := _kind(source, path, place):
        try:
            documents = bson.decode_all(_bytes(path))
        except BSONError as error:
            raise TmsError(DocumentNotRead(str(error)[:200])) from error
        for number, document in enumerate(documents, 1):
            _document(source, kind, f"{place}, document {number}", document)


def _json(source: Source, path: Path, place: str) -> None:
    if not (kind := _kind(source, path, place)):
        return
    text = _bytes(path).decode("utf-8", "replace")
    try:
        data = json_util.loads(text) if text.lstrip().startswith("[") else list(map(json_util.loads, text.splitlines()))
    except (json.JSONDecodeError, ValueError, TypeError) as error:
        raise TmsError(DocumentNotRead(str(error)[:200])) from error
    for number, document in enumerate((one for one in data if isinstance(one, dict)), 1):
        _document(source, kind, f"{place}, document {number}", document)


def _bytes(path: Path) -> bytes:
    with gzip.open(path) if path.suffix == ".gz" else path.open("rb") as file:
        try:
            data = file.read(MAX_DUMP + 1)
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            raise TmsError(DocumentNotRead(str(error))) from error
    if len(data) > MAX_DUMP:
        raise TmsError(DocumentTooLarge(MAX_DUMP / 2**20))
    return data


def _kind(source: Source, path: Path, place: str) -> str:
    """What the documents of a file are; the file is named after its collection, perhaps with the database before it."""
    name = Path(path.name.removesuffix(".gz")).stem
    kind = COLLECTIONS.get(name.rpartition(".")[2], "")
    if not kind:
        source.others.append(Unusable(place, NoCollectionOfTasks(name)))
    return kind


def _document(source: Source, kind: str, place: str, document: Document) -> None:
    document.pop("_id", None)
    if kind == "record":
        source.records.append(FoundRecord(place, document, dumped=True))
        return
    name = str(document.get("task_name") or document.get("description") or "")
    source.trees.append(Tree(place, str(document.get("task_sequence") or ""), name, document, kind))


READERS: dict[str, Callable[[Source, Path, str], None]] = {
    ".xml": _xml, ".yaml": _yaml, ".yml": _yaml, ".bson": _bson, ".json": _json,
}  # fmt: skip
