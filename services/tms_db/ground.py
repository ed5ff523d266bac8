"""Snapshots of the ground in the database: heights over `map` as GridFS files, each with its time.

They are terrain files of type `ground`, so `tms terrain list` and a backup have them, too.
"""

import io
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from tms_config.clock import utc_now
from tms_db.reasons import GroundNotThere, GroundUnreadable
from tms_db.store import Db
from tms_db.terrain import GROUND, Terrain, TerrainFile
from tms_reason.errors import DbError
from tms_soil.surface import Heights

FIRST, LAST = "first", "last"


@dataclass(frozen=True)
class Snapshot:
    """The ground at a time; its heights are read later."""

    file: TerrainFile
    taken_at: datetime  # UTC
    source: str  # where it comes from: the name of a file
    x0: float  # m, map: least x
    y0: float  # m, map: least y
    cell: float  # m
    rows: int
    columns: int

    def fits(self, time: str) -> bool:
        """Whether its local time begins so: 2026-11-26, or 2026-11-26T13:05."""
        return self.taken_at.astimezone().isoformat().startswith(time.replace(" ", "T"))


class GroundSnapshots:
    """All snapshots of a site."""

    def __init__(self, db: Db) -> None:
        self._terrain = Terrain(db)

    def add(self, ground: Heights, source: str) -> Snapshot:
        """Store a ground as that of now; heights are kept as 32-bit floats, exact to 4 um at 100 m.

        Raises:
            DbError: the store is away.
        """
        out, now = io.BytesIO(), utc_now()
        np.savez_compressed(out, z=ground.z.astype(np.float32))
        rows, columns = ground.z.shape
        more = {"x0": ground.x0, "y0": ground.y0, "cell": ground.cell, "rows": rows, "columns": columns,
                "frame": "map", "taken_at": now.isoformat(), "source": source}  # fmt: skip
        return _snapshot(self._terrain.put(GROUND, GROUND, out.getvalue(), more))

    def all(self) -> list[Snapshot]:
        """Newest first."""
        found = [_snapshot(file) for file in self._terrain.all(GROUND, GROUND)]
        return sorted(found, key=lambda one: one.taken_at, reverse=True)

    def find(self, word: str) -> Snapshot:
        """The snapshot that a user means: `last`, `first`, or the newest whose local time begins so.

        Raises:
            DbError: GROUND_NOT_THERE.
        """
        return chosen(self.all(), word)

    def read(self, snapshot: Snapshot) -> Heights:
        """The heights of a snapshot.

        Raises:
            DbError: it was removed meanwhile, or is damaged.
        """
        data = self._terrain.read(snapshot.file)
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as stored:
                z = stored["z"].astype(np.float64)
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error) as error:
            raise DbError(GroundUnreadable(snapshot.taken_at.isoformat())) from error
        if z.shape != (snapshot.rows, snapshot.columns):
            raise DbError(GroundUnreadable(snapshot.taken_at.isoformat()))
        return Heights(snapshot.x0, snapshot.y0, snapshot.cell, z)

    def remove(self, snapshot: Snapshot) -> None:
        """Take a snapshot away.

        Raises:
            DbError: the store is away.
        """
        self._terrain.delete(snapshot.file)


def chosen(snapshots: Sequence[Snapshot], word: str) -> Snapshot:
    """Among snapshots, newest first, the one that a user means.

    Raises:
        DbError: GROUND_NOT_THERE.
    """
    if word in (FIRST, LAST):
        found = snapshots[-1:] if word == FIRST else snapshots[:1]
    else:
        found = [one for one in snapshots if one.fits(word)][:1]
    if not found:
        raise DbError(GroundNotThere(word))
    return found[0]


def _snapshot(file: TerrainFile) -> Snapshot:
    more = file.more
    return Snapshot(
        file, datetime.fromisoformat(more["taken_at"]), str(more["source"]), float(more["x0"]), float(more["y0"]),
        float(more["cell"]), int(more["rows"]), int(more["columns"]),
    )  # fmt: skip
