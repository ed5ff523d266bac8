"""Terrain in the database: heightmaps, their colour images, point clouds and meshes as GridFS files.

The C++ system keeps them so (`fs.files`, `fs.chunks`; type, id, time and sizes beside the file name).

gridfs is imported when it is first used: most sites never store terrain.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tms_config.clock import utc_now
from tms_db import terrain_files
from tms_db.reasons import BadTerrainName, TerrainExists, TerrainMissing, TerrainNotWhole, TerrainSigns, TerrainSizes
from tms_db.store import Db, errors, long_work
from tms_db.terrain_files import IDS, IMAGES, Size, bad
from tms_reason import names
from tms_reason.errors import DbError

if TYPE_CHECKING:
    import gridfs

NEWEST_KEPT = 5  # versions of a dynamic cloud
LISTED = 1000
GROUND = "ground"  # name and type of snapshots of the ground
SIZES = ("width", "height", "elevation", "offset_x", "offset_y")


@dataclass(frozen=True)
class TerrainFile:
    """A terrain file in the database."""

    key: Any  # _id in GridFS
    filename: str
    type: str
    id: int
    time: str
    length: int  # bytes
    more: Mapping[str, Any]

    def size(self, name: str) -> float:
        """One of SIZES; 0 where the file has none."""
        value = self.more.get(name)
        return float(value) if isinstance(value, (int, float)) else 0.0


class Terrain:
    """The files in GridFS; the newest one of a name is valid."""

    def __init__(self, db: Db) -> None:
        self._db = db

    def add(self, path: Path, type_: str, size: Size | None = None) -> TerrainFile:
        """Store a file under its own name.

        Raises:
            DbError: BAD_TERRAIN, TERRAIN_EXISTS, or the store is away.
        """
        if type_ in IMAGES and size is None:
            raise bad(TerrainSizes(str(path), type_))
        if size is not None and not (size.width > 0 and size.height > 0 and size.elevation >= 0):
            raise bad(TerrainSigns(str(path)))
        data = terrain_files.read(path, type_)
        if self.find(type_, path.name) is not None:
            raise DbError(TerrainExists(type_, path.name))
        return self.put(path.name, type_, data, vars(size) if size is not None else {})

    def put(self, filename: str, type_: str, data: bytes, more: Mapping[str, Any]) -> TerrainFile:
        """Store checked data.

        Raises:
            DbError: the store is away.
        """
        if (why := names.name_flaw(filename)) is not None:
            raise bad(BadTerrainName(filename[:40], why))
        id_, time = IDS[type_], utc_now().isoformat()
        with long_work(self._db):
            key = self._grid().put(data, filename=filename, type=type_, id=id_, time=time, **more)
        return TerrainFile(key, filename, type_, id_, time, len(data), more)

    def put_dynamic(self, filename: str, data: bytes, more: Mapping[str, Any]) -> TerrainFile:
        """Store a cloud and delete all but the newest few of its name.

        Raises:
            DbError: the store is away.
        """
        stored = self.put(filename, "dynamic", data, more)
        for old in self.all("dynamic", filename)[NEWEST_KEPT:]:
            self.delete(old)
        return stored

    def all(self, type_: str = "", filename: str = "") -> list[TerrainFile]:
        """Files of a type and a name (each "" = any), newest first."""
        with errors():
            found = self._db["fs.files"].find({"filename": filename} if filename else {}).sort("uploadDate", -1)
            files = [_stored(document) for document in found.limit(LISTED)]
        return [file for file in files if file.type in ((type_,) if type_ else IDS)]

    def find(self, type_: str, filename: str = "") -> TerrainFile | None:
        """The newest file of a type and a name."""
        return next(iter(self.all(type_, filename)), None)

    def read(self, stored: TerrainFile) -> bytes:
        """The content of a file.

        Raises:
            DbError: TERRAIN_MISSING; it was removed meanwhile, or a part of it is missing.
        """
        from gridfs.errors import GridFSError

        with long_work(self._db):
            try:
                data: bytes = self._grid().get(stored.key).read()
            except GridFSError as error:
                raise DbError(TerrainNotWhole(stored.filename), "TERRAIN_MISSING") from error
        return data

    def remove(self, filename: str, type_: str = "") -> int:
        """Take all files of a name away; returns how many.

        Raises:
            DbError: TERRAIN_MISSING.
        """
        found = self.all(type_, filename)
        if not found or not filename:
            raise missing(filename)
        for file in found:
            self.delete(file)
        return len(found)

    def delete(self, file: TerrainFile) -> None:
        """Take one file away.

        Raises:
            DbError: the store is away.
        """
        with errors():
            self._grid().delete(file.key)

    def _grid(self) -> "gridfs.GridFS":
        import gridfs

        return gridfs.GridFS(self._db)


def missing(filename: str) -> DbError:
    """The error for a terrain that is not stored."""
    return DbError(TerrainMissing(filename))


def _stored(document: Mapping[str, Any]) -> TerrainFile:
    # Drivers other than Python's put the fields of a file below `metadata`.
    more = {**(document.get("metadata") or {}), **document}
    id_ = more.get("id")
    return TerrainFile(
        document["_id"], str(document.get("filename") or ""), str(more.get("type") or ""),
        int(id_) if isinstance(id_, (int, float)) else 0, str(more.get("time") or ""), int(document["length"]), more,
    )  # fmt: skip
