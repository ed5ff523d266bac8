"""A piece of a recording: what one machine told within some seconds, packed into one document.

Numbers are kept as whole multiples of UNIT and as differences from one row to the next: a machine that stands is then
nearly all zeros, which compress to nothing. A piece of 10 s takes 1 to 3 kB.
"""

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

import numpy as np
import numpy.typing as npt

UNIT = 1e-5  # s, rad, m, kg, m3
NUMBER = np.dtype("<i8")
LARGEST = 2.0**60  # units; a machine may tell any number
JOINTS, POSE, LOAD = "joints", "pose", "load"
COLUMNS = {POSE: ("x", "y", "yaw"), LOAD: ("mass", "bank", "loose")}  # m, m, rad; kg, m3, m3; joints have their names

Rows = npt.NDArray[np.float64]


@dataclass
class Piece:
    """The piece that is being made."""

    machine: str
    begin: datetime  # UTC, whole milliseconds, which is what the store keeps
    since: float  # s, monotonic, at `begin`
    _names: dict[str, tuple[str, ...]] = field(default_factory=dict)
    _rows: dict[str, list[tuple[float, ...]]] = field(default_factory=dict)

    def add(self, kind: str, names: Sequence[str], now: float, values: Sequence[float]) -> None:
        """Add what was told at `now` [s, monotonic]."""
        self._names[kind] = tuple(names)
        self._rows.setdefault(kind, []).append((now - self.since, *values))

    def document(self) -> dict[str, Any] | None:
        """The piece as it is stored; None as long as nothing is in it."""
        if not self._rows:
            return None
        series = {
            kind: {"names": list(self._names[kind]), "rows": len(rows), "data": packed(np.array(rows))}
            for kind, rows in self._rows.items()
        }
        return {"machine": self.machine, "begin": self.begin, "series": series}


def packed(rows: Rows) -> bytes:
    """Rows of times and values as bytes."""
    whole = np.round(np.clip(rows / UNIT, -LARGEST, LARGEST)).astype(NUMBER)
    return zlib.compress(np.diff(whole, axis=0, prepend=NUMBER.type(0)).T.tobytes())


def unpacked(stored: Mapping[str, Any]) -> Rows:
    """The rows of a series in a stored piece: seconds since the begin of the piece, then the values by its names.

    Raises:
        ValueError, zlib.error, KeyError: it is damaged.
    """
    columns = np.frombuffer(zlib.decompress(stored["data"]), NUMBER).reshape(1 + len(stored["names"]), stored["rows"])
    return np.cumsum(columns.T, axis=0).astype(np.float64) * UNIT
